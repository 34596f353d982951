// Methods of lists and queues.
#include <fmt/format.h>

#include <map>

#include "koord/check/checker.h"
#include "koord/check/targets.h"

namespace rondo::koord {

using diag::Kind;
using lang::ExprKind;

TypeId Checker::CallMethod(ExprId id, const lang::Expr& e) {
  auto& types = model_.types;
  const lang::Expr& callee = exprs_[e.args[0]];
  const TypeId list = Expr(callee.args[0]);
  static const std::map<std::string, Builtin> kMethods{
      {"append", Builtin::kAppend}, {"add", Builtin::kAppend},    {"push", Builtin::kAppend},
      {"remove", Builtin::kRemove}, {"clear", Builtin::kClear},   {"contains", Builtin::kContains},
      {"front", Builtin::kFront},   {"insert", Builtin::kInsert}, {"pop", Builtin::kPop}};
  const auto method = kMethods.find(callee.text);
  if (method == kMethods.end()) {
    auto& report = diagnostics_.Report(Kind::kKoordNotCallable, callee.span,
                                       fmt::format("there is no method `{}`", callee.text));
    report.Help(
        "lists have `append` (or `push`), `insert`, `remove`, `pop`, `clear`, `contains` and `front`");
    for (size_t i = 1; i < e.args.size(); ++i) Expr(e.args[i]);
    return types.error();
  }
  const Builtin builtin = method->second;
  Set(id, RefKind::kBuiltin, static_cast<size_t>(builtin));
  if (WritesList(builtin) && id != statement_call_) {
    diagnostics_
        .Report(Kind::kKoordNotCallable, e.span,
                fmt::format("`{}` changes its list, and has no value", callee.text))
        .Help(builtin == Builtin::kPop
                  ? "take `q.front()` or `l[i]` first, and write `pop` in a line of its own"
                  : "write it in a line of its own");
  }
  const size_t most = builtin == Builtin::kClear || builtin == Builtin::kFront ? 0
                      : builtin == Builtin::kInsert                            ? 2
                                                                               : 1;
  if (!Arity(e, builtin == Builtin::kPop ? 0 : most, most, callee.text)) return types.error();
  const TypeId element = types.FreshVariable();
  if (!types.Unify(list, types.List(element))) {
    return Mismatch(exprs_[callee.args[0]].span,
                    fmt::format("`{}` needs a list, not a `{}`", callee.text, types.Name(list)));
  }
  if (builtin == Builtin::kPop && e.args.size() == 1 && !IsQueue(callee.args[0])) {
    // Elsewhere, it is the last item of a list that goes.
    diagnostics_
        .Report(Kind::kKoordNotCallable, e.span,
                "`pop()` takes away the first item of what is declared as a `Queue`")
        .Help("of any list, `l.pop(0)` takes away the first item, `l.pop(len(l) - 1)` the last");
  }
  const bool indexed = builtin == Builtin::kInsert || builtin == Builtin::kPop;
  if (indexed && e.args.size() > 1) NeedType(e.args[1], types.integer(), "an index");
  if (most > 0 && builtin != Builtin::kPop)
    NeedType(e.args[most], element, fmt::format("the argument of `{}`", callee.text));
  if (builtin == Builtin::kFront) return element;
  if (builtin == Builtin::kContains) return types.boolean();
  return types.error();  // a statement, not a value
}

// Is it a variable that is declared as a `Queue`? Queues and lists are one type.
bool Checker::IsQueue(ExprId list) const {
  const Ref ref = model_.RefOf(list);
  const bool item = exprs_[list].kind == ExprKind::kIndex && ref.kind == RefKind::kNone;
  if (item) return IsQueue(exprs_[list].args[0]);
  return (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell) && queues_.contains(ref.index);
}

}  // namespace rondo::koord
