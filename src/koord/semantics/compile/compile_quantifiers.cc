#include <algorithm>
#include <functional>

#include "koord/semantics/compile/compiler.h"
#include "lang/expr_queries.h"

namespace rondo::koord::semantics {

using lang::ExprKind;
using lang::TypeKind;

bool Compiler::Mentions(ExprId id, const std::vector<uint32_t>& bindings) const {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kBinding &&
      std::find(bindings.begin(), bindings.end(), ref.index) != bindings.end())
    return true;
  return std::any_of(e.args.begin(), e.args.end(), [&](ExprId a) { return Mentions(a, bindings); });
}

// Does it have a value wherever it stands? Sums may overflow, and items be none.
bool Compiler::CannotFail(ExprId id) const {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  switch (e.kind) {
    case ExprKind::kInt:
    case ExprKind::kPid:
      return true;
    case ExprKind::kName:
    case ExprKind::kField:
      return ref.kind != RefKind::kNone;
    case ExprKind::kCall:
      return ref.kind == RefKind::kBuiltin && static_cast<Builtin>(ref.index) == Builtin::kLen &&
             CannotFail(e.args[1]);
    default:
      return false;
  }
}

// From `v < e`, `e <= v` and the like. If e is another variable that is not bound yet, its limits are limits
// of v, too.
void Compiler::Limits(uint32_t binding, bool upper, const std::vector<ExprId>& conditions,
                      const std::vector<uint32_t>& unbound, std::vector<uint32_t>& seen,
                      std::vector<Limit>& limits) const {
  if (std::find(seen.begin(), seen.end(), binding) != seen.end()) return;
  seen.push_back(binding);
  // Conditions are asked one after the other: only those at the front, which bound variables, are always.
  bool first = true;
  for (const ExprId id : conditions) {
    const lang::Expr& e = exprs_[id];
    first = first && e.kind == ExprKind::kBinary &&
            (e.text[0] == '<' || e.text[0] == '>' || e.text == "==") &&
            std::ranges::any_of(e.args, [&](ExprId a) { return model_.RefOf(a).kind == RefKind::kBinding; });
    if (e.kind != ExprKind::kBinary) continue;
    const bool equal = e.text == "==";
    if (!equal && e.text[0] != '<' && e.text[0] != '>') continue;
    for (size_t side = 0; side < 2; ++side) {
      const Ref ref = model_.RefOf(e.args[side]);
      if (ref.kind != RefKind::kBinding || ref.index != binding) continue;
      const bool below = (e.text[0] == '<') == (side == 0);  // the variable is the smaller one
      if (!equal && below != upper) continue;
      const ExprId other = e.args[1 - side];
      if (!model_.types.Is(model_.TypeOf(other), TypeKind::kInt) || (!first && !CannotFail(other))) continue;
      const bool strict = e.text.size() == 1;
      // Half-open: from the lower limit up to, not including, the upper one.
      const int64_t plus = upper ? (strict ? 0 : 1) : (strict ? 1 : 0);
      const Ref to = model_.RefOf(other);
      if (!Mentions(other, unbound)) {
        limits.push_back({other, plus});
      } else if (to.kind == RefKind::kBinding && to.index != binding) {
        Limits(to.index, upper, conditions, unbound, seen, limits);
      }
    }
  }
}

void Compiler::Range(const std::vector<Limit>& limits, Op pick, uint32_t slot) {
  for (size_t i = 0; i < limits.size(); ++i) {
    Gen(limits[i].value);
    if (limits[i].plus != 0) {
      Constant(FromInt(limits[i].plus));
      Emit(Op::kAddInt);
    }
    if (i > 0) Emit(pick);
  }
  Emit(Op::kSetFrame, slot, 1);
}

void Compiler::Quantifier(ExprId id, const lang::Expr& e) {
  const bool forall = e.text == "forall";
  const Model::Domains& domains = model_.domains.at(id);
  std::vector<Bound> all;
  for (size_t b = 0; b < e.binders.size(); ++b) {
    for (const uint32_t binding : domains.bindings[b])
      all.push_back({binding, domains.kinds[b], e.binders[b].domain});
  }
  // Ints last: what bounds them may mention the others.
  std::vector<uint32_t> ints;
  for (const Bound& b : all) {
    if (b.kind == DomainKind::kType && model_.types.Is(model_.bindings[b.binding].type, TypeKind::kInt))
      ints.push_back(b.binding);
  }
  const bool lists = std::any_of(all.begin(), all.end(), [&](const Bound& b) {
    return b.kind == DomainKind::kList && Mentions(b.list, ints);
  });
  if (!lists) {
    std::stable_partition(all.begin(), all.end(), [&](const Bound& b) {
      return std::find(ints.begin(), ints.end(), b.binding) == ints.end();
    });
  }
  std::vector<size_t> decided;
  Loop(all, 0, e.args[0], forall, decided);
  Constant(forall);
  const size_t out = Emit(Op::kJump);
  for (const size_t jump : decided) Patch(jump);
  Constant(!forall);
  Patch(out);
}

// Leaves by one of the jumps `decided` if an instance decides the quantifier, else falls through.
void Compiler::Loop(const std::vector<Bound>& all, size_t i, ExprId body, bool forall,
                    std::vector<size_t>& decided) {
  if (i == all.size()) {
    Gen(body);
    decided.push_back(Emit(forall ? Op::kJumpUnless : Op::kJumpIf));
    return;
  }
  const Bound& bound = all[i];
  const TypeId type = model_.bindings[bound.binding].type;
  const uint32_t variable = FrameOf(bound.binding);
  const bool over_list = bound.kind == DomainKind::kList;
  const uint32_t index = over_list ? NewFrame(1) : variable;
  const uint32_t end = NewFrame(1);
  const uint32_t list = over_list ? NewFrame(1) : 0;
  Constant(0);
  Emit(Op::kSetFrame, index, 1);
  if (over_list) {
    Gen(bound.list);
    Emit(Op::kSetFrame, list, 1);
    Emit(Op::kFrame, list, 1);
    Emit(Op::kListLength, Width(type));
    Emit(Op::kSetFrame, end, 1);
  } else if (bound.kind == DomainKind::kRobots) {
    Constant(FromInt(static_cast<int64_t>(layout_.robots())));
    Emit(Op::kSetFrame, end, 1);
  } else if (model_.types.Is(type, TypeKind::kBool) || model_.types.Is(type, TypeKind::kEnum)) {
    Constant(model_.types.Is(type, TypeKind::kBool) ? 2 : model_.types[type].fields.size());
    Emit(Op::kSetFrame, end, 1);
  } else if (model_.types.Is(type, TypeKind::kInt)) {
    // forall x: A implies B asks for the x with A only, exists x: A for those with A.
    const std::vector<ExprId> conditions = lang::SuppositionsOf(exprs_, body, forall);
    std::vector<uint32_t> unbound;
    for (size_t k = i; k < all.size(); ++k) unbound.push_back(all[k].binding);
    std::vector<Limit> lower;
    std::vector<Limit> upper;
    std::vector<uint32_t> seen;
    Limits(bound.binding, false, conditions, unbound, seen, lower);
    seen.clear();
    Limits(bound.binding, true, conditions, unbound, seen, upper);
    if (lower.empty() || upper.empty()) {
      return Fail(model_.bindings[bound.binding].span, "nothing bounds the ints that it is about");
    }
    Range(lower, Op::kMaxInt, index);
    Range(upper, Op::kMinInt, end);
  } else {
    return Fail(model_.bindings[bound.binding].span,
                "it is about all values of `" + model_.types.Name(type) + "`");
  }
  Emit(Op::kFrame, index, 1);
  Emit(Op::kFrame, end, 1);
  Emit(Op::kLessInt);
  const size_t empty = Emit(Op::kJumpUnless);
  const size_t top = Here();
  if (over_list) {
    Emit(Op::kFrame, list, 1);
    Emit(Op::kFrame, index, 1);
    Emit(Op::kListAt, Width(type));
    Emit(Op::kSetFrame, variable, Width(type));
  }
  Loop(all, i + 1, body, forall, decided);
  Emit(Op::kForNext, index, end, top);
  Patch(empty);
}

}  // namespace rondo::koord::semantics
