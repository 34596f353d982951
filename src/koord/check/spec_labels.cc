#include "koord/check/spec_labels.h"

#include <fmt/format.h>

#include <algorithm>

#include "lang/expr_printer.h"

namespace rondo::koord {

namespace {

bool Stops(const std::vector<Stmt>& body) {
  return std::any_of(body.begin(), body.end(), [](const Stmt& s) {
    return s.kind == StmtKind::kStop || Stops(s.body) || Stops(s.orelse);
  });
}

}  // namespace

bool RobotsStop(const Model& model) {
  const auto stops = [](const auto* part) { return Stops(part->body); };
  return std::any_of(model.events.begin(), model.events.end(), stops) ||
         std::any_of(model.inits.begin(), model.inits.end(), stops);
}

std::string InvariantName(const Model& model, size_t i) {
  const InvariantDef& def = *model.invariants[i];
  if (!def.name.empty()) return def.name;
  // Proofs tell invariants apart by name: never one that somebody has written.
  std::string name = fmt::format("invariant{}", i + 1);
  const bool taken = std::any_of(model.invariants.begin(), model.invariants.end(),
                                 [&](const InvariantDef* other) { return other->name == name; });
  return taken ? name + " (unnamed)" : name;
}

std::string AssumptionName(const Model& model, const AssumeDef& def) {
  const lang::ExprPool& exprs = model.program->exprs;
  switch (def.kind) {
    case AssumeKind::kInitially:
      return "initially " + lang::PrintExpr(exprs, def.body);
    case AssumeKind::kFact:
      return def.name.empty() ? lang::PrintExpr(exprs, def.body) : def.name;
    case AssumeKind::kPort:
      break;
  }
  if (!def.name.empty()) return fmt::format("{}.{}", def.module, def.name);
  int number = 0;
  int unnamed = 0;
  for (const AssumeDef* other : model.assumptions) {
    if (other->kind != AssumeKind::kPort || other->module != def.module || !other->name.empty()) continue;
    ++unnamed;
    if (other == &def) number = unnamed;
  }
  return unnamed == 1 ? def.module : fmt::format("{} ({})", def.module, number);
}

std::string SummaryName(const SummaryDef& def) { return "summary " + def.function; }

bool UsesFloatArithmetic(const Model& model) {
  for (size_t i = 0; i < model.program->exprs.size(); ++i) {
    const ExprId id(i);
    const lang::Expr& e = model.program->exprs[id];
    const TypeId type = model.TypeOf(id);
    const bool real = model.types.Is(type, lang::TypeKind::kFloat) || type == model.types.pos();
    const bool arithmetic = e.kind == lang::ExprKind::kBinary &&
                            (e.text == "+" || e.text == "-" || e.text == "*" || e.text == "/");
    const Ref ref = model.RefOf(id);
    const bool middle = e.kind == lang::ExprKind::kCall && ref.kind == RefKind::kBuiltin &&
                        (static_cast<Builtin>(ref.index) == Builtin::kMid ||
                         static_cast<Builtin>(ref.index) == Builtin::kDist);
    if (real && (arithmetic || middle)) return true;
  }
  return false;
}

bool UsesOld(const Model& model, ExprId id) {
  const lang::Expr& e = model.program->exprs[id];
  const Ref ref = model.RefOf(id);
  if (e.kind == lang::ExprKind::kCall && ref.kind == RefKind::kBuiltin &&
      static_cast<Builtin>(ref.index) == Builtin::kOld)
    return true;
  return std::any_of(e.args.begin(), e.args.end(), [&](ExprId arg) { return UsesOld(model, arg); });
}

bool HoldsAlways(const Model& model, const AssumeDef& def) {
  return !def.when.valid() && !def.at_end && !UsesOld(model, def.body);
}

}  // namespace rondo::koord
