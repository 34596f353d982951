#include <fmt/format.h>

#include <algorithm>

#include "koord/check/checker.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;
using lang::ExprKind;
using lang::TypeKind;

namespace {

struct BuiltinName {
  std::string_view name;
  Builtin builtin;
};
constexpr BuiltinName kBuiltins[] = {
    {"pos", Builtin::kPos},         {"pos3d", Builtin::kPos},   {"mid", Builtin::kMid},
    {"midpoint", Builtin::kMid},    {"dist", Builtin::kDist},   {"len", Builtin::kLen},
    {"abs", Builtin::kAbs},         {"min", Builtin::kMin},     {"max", Builtin::kMax},
    {"old", Builtin::kOld},         {"rect", Builtin::kRect},   {"grid", Builtin::kGrid},
    {"sqrt", Builtin::kSqrt},       {"hypot", Builtin::kHypot}, {"floor", Builtin::kFloor},
    {"ceil", Builtin::kCeil},       {"round", Builtin::kRound}, {"sign", Builtin::kSign},
    {lang::kSlice, Builtin::kSlice}};

}  // namespace

bool Checker::Arity(const lang::Expr& e, size_t least, size_t most, std::string_view name) {
  const size_t given = e.args.size() - 1;
  if (given >= least && given <= most) return true;
  const std::string wanted = least == most ? fmt::format("{}", least)
                             : most > 100  ? fmt::format("at least {}", least)
                                           : fmt::format("{} or {}", least, most);
  diagnostics_
      .Report(Kind::kKoordArity, e.span,
              fmt::format("`{}` takes {} argument{}", name, wanted, wanted == "1" ? "" : "s"))
      .Under(fmt::format("{} given", given));
  for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
  return false;
}

TypeId Checker::Call(ExprId id, const lang::Expr& e) {
  const lang::Expr& callee = exprs_[e.args[0]];
  const auto call_port = [&](int port, const std::string& name) {
    const Variable& v = model_.variables[static_cast<size_t>(port)];
    if (v.function >= 0) return CallFunction(id, e, static_cast<size_t>(v.function));
    diagnostics_.Report(Kind::kKoordNotCallable, callee.span, fmt::format("`{}` cannot be called", name))
        .At(v.span, fmt::format("declared as {}", model_.types.WithArticle(v.type)))
        .Help("a sensor of type `PathPlanner` is called like a function");
    for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
    return model_.types.error();
  };
  if (callee.kind == ExprKind::kField) {
    if (!IsModuleName(callee.args[0])) return CallMethod(id, e);
    const std::string& module = exprs_[callee.args[0]].text;
    const int port = FindPort(module, callee.text, callee.span, true);
    if (port >= 0) return call_port(port, model_.variables[static_cast<size_t>(port)].name);
    for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
    return model_.types.error();
  }
  if (callee.kind == ExprKind::kName) {
    const std::string& name = callee.text;
    if (const int v = FindVariable(name); v >= 0) return call_port(v, name);
    if (!claimed_.contains(name)) {
      for (const BuiltinName& builtin : kBuiltins) {
        if (builtin.name == name) return CallBuiltin(id, e, builtin.builtin);
      }
      // A bare port name, as in `planner(target)`.
      for (size_t i = 0; i < model_.variables.size(); ++i) {
        const Variable& v = model_.variables[i];
        if (v.function >= 0 && v.name == v.module + "." + name) return call_port(static_cast<int>(i), v.name);
      }
    }
    if (const auto type = model_.named_types.find(name);
        type != model_.named_types.end() && model_.types.Is(type->second, TypeKind::kRecord))
      return MakeRecord(id, e, type->second);
    if (IsModule(name) || model_.named_types.contains(name)) {
      diagnostics_.Report(Kind::kKoordNotCallable, callee.span, fmt::format("`{}` is not a function", name));
      for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
      return model_.types.error();
    }
    return CallFunction(id, e, FunctionNamed(name, e.args.size() - 1, callee.span));
  }
  Expr(e.args[0]);
  for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
  diagnostics_.Report(Kind::kKoordNotCallable, callee.span, "only functions can be called");
  return model_.types.error();
}

// The function of this name; an external one with unknown types if it is new.
size_t Checker::FunctionNamed(const std::string& name, size_t arity, Span span) {
  for (size_t i = 0; i < model_.functions.size(); ++i) {
    if (model_.functions[i].name == name) return i;
  }
  UnknownFunction(name, span);
  Function function{name, {}, {}, model_.types.FreshVariable(), nullptr, true, span, -1};
  for (size_t i = 0; i < arity; ++i) {
    function.parameter_names.push_back(fmt::format("x{}", i + 1));
    function.parameters.push_back(model_.types.FreshVariable());
  }
  model_.functions.push_back(std::move(function));
  return model_.functions.size() - 1;
}

// A function that nothing describes: not a declaration, nor a summary, nor a body for exploration.
void Checker::UnknownFunction(const std::string& name, Span span) {
  if (name.find('.') != std::string::npos) return;  // a member of a type that nobody looks into
  for (const Item& item : program_.items) {
    if (const auto* summary = std::get_if<SummaryDef>(&item); summary != nullptr && summary->function == name)
      return;
    const auto* explore = std::get_if<ExploreDef>(&item);
    const auto describes = [&](const ExploreEntry& entry) { return entry.name == name; };
    if (explore != nullptr && std::any_of(explore->entries.begin(), explore->entries.end(), describes))
      return;
  }
  auto& report = diagnostics_.Report(Kind::kKoordUnknownFunction, span,
                                     fmt::format("`{}` is declared nowhere: it may return anything", name));
  std::vector<std::string> known;
  for (const BuiltinName& builtin : kBuiltins) known.emplace_back(builtin.name);
  for (const Function& f : model_.functions) known.push_back(f.name);
  std::string near = lang::Suggest(name, known);
  // Words of other languages for what is here.
  static const std::map<std::string, std::string> kOtherWords{
      {"distance", "dist"}, {"norm", "dist"},    {"midpoint", "mid"}, {"length", "len"}, {"size", "len"},
      {"fabs", "abs"},      {"minimum", "min"},  {"maximum", "max"},  {"point", "pos"},  {"Point", "pos"},
      {"root", "sqrt"},     {"ceiling", "ceil"}, {"sgn", "sign"},     {"int", "floor"},  {"trunc", "floor"}};
  if (const auto it = kOtherWords.find(name); it != kOtherWords.end()) near = it->second;
  if (!near.empty()) {
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(span, near);
  } else {
    report.Help(fmt::format("if that is meant, declare it: `def fun {}(...) -> ...`", name));
  }
}

TypeId Checker::CallFunction(ExprId id, const lang::Expr& e, size_t index) {
  auto& types = model_.types;
  Set(id, RefKind::kFunction, index);
  if (function_ >= 0) calls_[function_].insert(index);
  if (!model_.functions[index].declared) {
    // A callable port: its first call tells how many arguments it takes.
    Function& f = model_.functions[index];
    f.declared = true;
    f.result = types.FreshVariable();
    for (size_t i = 1; i < e.args.size(); ++i) {
      f.parameters.push_back(types.FreshVariable());
      f.parameter_names.push_back(fmt::format("x{}", i));
    }
  }
  const size_t parameters = model_.functions[index].parameters.size();
  if (parameters != e.args.size() - 1) {
    const Function f = model_.functions[index];
    diagnostics_
        .Report(Kind::kKoordArity, e.span,
                fmt::format("`{}` takes {} argument{}", f.name, parameters, parameters == 1 ? "" : "s"))
        .Under(fmt::format("{} given", e.args.size() - 1))
        .At(f.span, f.def != nullptr ? "declared here" : "first used here");
    for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
    return f.result;
  }
  for (size_t i = 0; i < parameters; ++i) {
    const TypeId given = Expr(e.args[i + 1]);
    const TypeId wanted = model_.functions[index].parameters[i];
    if (types.Coerce(given, wanted)) continue;
    const Function& f = model_.functions[index];
    auto& report = diagnostics_.Report(
        Kind::kKoordTypeMismatch, exprs_[e.args[i + 1]].span,
        fmt::format("argument {} of `{}` must be {}", i + 1, f.name, types.WithArticle(wanted)));
    report.Under(fmt::format("this is {}", types.WithArticle(given)));
    report.At(f.span, f.def != nullptr ? "declared here" : "its first use decided so");
    if (f.def == nullptr) report.Help(fmt::format("declare it: `def fun {}(...) -> ...`", f.name));
  }
  return model_.functions[index].result;
}

// Order(1, pos(0, 0, 0)): the members in order.
TypeId Checker::MakeRecord(ExprId id, const lang::Expr& e, TypeId record) {
  Set(id, RefKind::kBuiltin, static_cast<size_t>(Builtin::kRecord));
  const std::vector<TypeId> parts = model_.types[record].parts;
  const std::vector<std::string> fields = model_.types[record].fields;
  if (!Arity(e, parts.size(), parts.size(), exprs_[e.args[0]].text)) return record;
  for (size_t i = 0; i < parts.size(); ++i) NeedType(e.args[i + 1], parts[i], fmt::format("`{}`", fields[i]));
  return record;
}

TypeId Checker::CallBuiltin(ExprId id, const lang::Expr& e, Builtin builtin) {
  auto& types = model_.types;
  Set(id, RefKind::kBuiltin, static_cast<size_t>(builtin));
  const std::string& name = exprs_[e.args[0]].text;
  switch (builtin) {
    case Builtin::kPos:
      if (!Arity(e, 2, 3, name)) return types.pos();
      for (size_t i = 1; i < e.args.size(); ++i) NeedType(e.args[i], types.real(), "a coordinate");
      return types.pos();
    case Builtin::kMid:
    case Builtin::kDist: {
      // mid([p, q]) and mid(p, q)
      std::vector<ExprId> points(e.args.begin() + 1, e.args.end());
      if (points.size() == 1 && exprs_[points[0]].kind == ExprKind::kList &&
          exprs_[points[0]].args.size() == 2) {
        Expr(points[0]);
        points = exprs_[points[0]].args;
      } else if (!Arity(e, 2, 2, name)) {
        return types.error();
      }
      const TypeId a = Expr(points[0]);
      const TypeId b = Expr(points[1]);
      const TypeId result = builtin == Builtin::kDist ? types.real()
                            : types.IsNumeric(a)      ? types.real()
                                                      : types.pos();
      if (types.IsNumeric(a) && types.IsNumeric(b)) return result;
      if (types.Unify(a, types.pos()) && types.Unify(b, types.pos())) return result;
      diagnostics_
          .Report(Kind::kKoordTypeMismatch, e.span, fmt::format("`{}` needs two points or two numbers", name))
          .At(exprs_[points[0]].span, fmt::format("`{}`", types.Name(a)))
          .At(exprs_[points[1]].span, fmt::format("`{}`", types.Name(b)));
      return types.error();
    }
    case Builtin::kLen: {
      if (!Arity(e, 1, 1, name)) return types.integer();
      const TypeId list = Expr(e.args[1]);
      if (!types.Unify(list, types.List(types.FreshVariable()))) {
        Mismatch(exprs_[e.args[1]].span, fmt::format("`len` needs a list, not {}", types.WithArticle(list)));
      }
      return types.integer();
    }
    case Builtin::kAbs:
    case Builtin::kMin:
    case Builtin::kMax: {
      if (!Arity(e, builtin == Builtin::kAbs ? 1 : 2, builtin == Builtin::kAbs ? 1 : 1000, name))
        return types.error();
      bool all_int = true;
      for (size_t i = 1; i < e.args.size(); ++i) {
        const TypeId t = Expr(e.args[i]);
        all_int = all_int && types.Is(t, TypeKind::kInt);
        if (!types.Coerce(t, types.real())) {
          Mismatch(exprs_[e.args[i]].span,
                   fmt::format("`{}` needs numbers, not {}", name, types.WithArticle(t)));
        }
      }
      return all_int ? types.integer() : types.real();
    }
    case Builtin::kRecord:
      break;  // has no name of its own
    case Builtin::kSqrt:
    case Builtin::kHypot: {
      const size_t wanted = builtin == Builtin::kHypot ? 2 : 1;
      if (!Arity(e, wanted, wanted, name)) return types.real();
      for (size_t i = 1; i < e.args.size(); ++i)
        NeedType(e.args[i], types.real(), fmt::format("the argument of `{}`", name));
      return types.real();
    }
    case Builtin::kFloor:
    case Builtin::kCeil:
    case Builtin::kRound:
    case Builtin::kSign:
      if (!Arity(e, 1, 1, name)) return types.integer();
      NeedType(e.args[1], types.real(), fmt::format("the argument of `{}`", name));
      return types.integer();
    case Builtin::kOld: {
      if (!Arity(e, 1, 1, name)) return types.error();
      if (!old_allowed_) {
        diagnostics_
            .Report(Kind::kKoordSpecScope, e.span, "`old` has a meaning only behind `always` and `finally`")
            .Help("there it is the value at the end of the program transition");
      }
      return Expr(e.args[1]);
    }
    case Builtin::kRect:
      Arity(e, 2, 2, name);
      return Mismatch(e.span, "`rect(a, b)` can only stand behind `in`");
    case Builtin::kGrid: {
      if (!grid_element_.valid()) {
        diagnostics_
            .Report(Kind::kKoordSpecScope, e.span, "`grid` has a meaning only behind `in` in `explore`")
            .Help("elsewhere, write a list");
        return types.error();
      }
      if (!Arity(e, 3, 3, name)) return types.error();
      const TypeId element = grid_element_;
      if (!types.IsNumeric(element) && types.Resolve(element) != types.pos())
        return Mismatch(e.span, fmt::format("a grid has numbers or points, not values of type `{}`",
                                            types.Name(element)));
      NeedType(e.args[1], element, "the first point of a grid");
      NeedType(e.args[2], element, "the last point of a grid");
      NeedType(e.args[3], types.Is(element, TypeKind::kInt) ? element : types.real(), "the step of a grid");
      return types.List(element);
    }
    case Builtin::kSlice: {
      const TypeId list = Expr(e.args[1]);
      if (!types.Unify(list, types.List(types.FreshVariable())))
        return Mismatch(exprs_[e.args[1]].span,
                        fmt::format("only lists have slices, not {}", types.WithArticle(list)));
      NeedType(e.args[2], types.integer(), "the start of a slice");
      if (e.args.size() > 3) NeedType(e.args[3], types.integer(), "the end of a slice");
      return list;
    }
    case Builtin::kRemove:
    case Builtin::kInsert:
    case Builtin::kPop:
    case Builtin::kClear:
    case Builtin::kContains:
    case Builtin::kFront:
    case Builtin::kAppend:
      break;  // methods
  }
  return types.error();
}

void Checker::CheckRecursion() {
  for (const auto& [function, _] : calls_) {
    std::set<size_t> seen;
    std::vector<size_t> stack{static_cast<size_t>(function)};
    bool cycle = false;
    while (!stack.empty() && !cycle) {
      const size_t f = stack.back();
      stack.pop_back();
      const auto it = calls_.find(static_cast<int>(f));
      if (it == calls_.end()) continue;
      for (const size_t callee : it->second) {
        cycle = cycle || callee == static_cast<size_t>(function);
        if (seen.insert(callee).second) stack.push_back(callee);
      }
    }
    if (!cycle) continue;
    const Function& f = model_.functions[static_cast<size_t>(function)];
    diagnostics_.Report(Kind::kKoordRecursion, f.span, fmt::format("`{}` calls itself", f.name))
        .Help("use a bounded `for` loop: an event must end");
  }
}

// Every type must be known in the end.
void Checker::CheckSignatures() {
  if (diagnostics_.has_errors()) return;
  for (const Function& f : model_.functions) {
    if (!f.declared) continue;  // a callable port that is never called
    if (f.def != nullptr && f.def->has_body && model_.types.Is(f.result, TypeKind::kVariable)) continue;
    const auto open = std::find_if(f.parameters.begin(), f.parameters.end(),
                                   [&](TypeId t) { return model_.types.HasVariable(t); });
    const bool result_open = model_.types.HasVariable(f.result);
    // A function that is only called as a statement returns nothing of interest.
    if (open == f.parameters.end() && !result_open) continue;
    if (open == f.parameters.end() && model_.types.Is(f.result, TypeKind::kVariable)) {
      model_.types.Unify(f.result, model_.types.boolean());
      continue;
    }
    diagnostics_
        .Report(Kind::kKoordUnknownSignature, f.span,
                fmt::format("the type of `{}` cannot be told from its uses", f.name))
        .Help(fmt::format("declare it: `def fun {}(...) -> ...`", f.name));
  }
}

}  // namespace rondo::koord
