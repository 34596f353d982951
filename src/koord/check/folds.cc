#include <fmt/format.h>

#include "koord/check/checker.h"

namespace rondo::koord {

using diag::Kind;
using lang::TypeKind;

std::optional<FoldKind> FoldOf(std::string_view word) {
  constexpr std::pair<std::string_view, FoldKind> kFolds[] = {
      {"count", FoldKind::kCount}, {"sum", FoldKind::kSum},       {"min", FoldKind::kMin},
      {"max", FoldKind::kMax},     {"argmin", FoldKind::kArgmin}, {"argmax", FoldKind::kArgmax}};
  for (const auto& [name, kind] : kFolds) {
    if (name == word) return kind;
  }
  return std::nullopt;
}

// `sum i in ID: e`: over all robots, each once.
TypeId Checker::Fold(ExprId id, const lang::Expr& e) {
  auto& types = model_.types;
  const FoldKind kind = *FoldOf(e.text);
  const TypeId otherwise = kind == FoldKind::kSum || kind == FoldKind::kMin || kind == FoldKind::kMax
                               ? types.error()
                               : types.integer();
  const lang::Binder& binder = e.binders[0];
  const lang::Expr* domain = binder.domain.valid() ? &exprs_[binder.domain] : nullptr;
  const bool robots = domain != nullptr && domain->kind == lang::ExprKind::kName && domain->text == "ID" &&
                      FindVariable("ID") < 0;
  if (!robots || e.binders.size() > 1 || binder.names.size() > 1) {
    diagnostics_
        .Report(Kind::kKoordTypeMismatch, e.span,
                fmt::format("`{}` goes over all robots, one variable", e.text))
        .Help(fmt::format("write `{} i in ID: ...`; for lists, use a loop", e.text));
    return otherwise;
  }
  const size_t depth = scope_.size();
  Model::Domains domains;
  domains.kinds.push_back(DomainKind::kRobots);
  domains.bindings.push_back({Bind(binder.names[0], types.integer(), binder.spans[0])});
  const bool may_choose = std::exchange(may_choose_, false);
  TypeId result = otherwise;
  if (kind == FoldKind::kCount) {
    NeedBool(e.args[0], "the body of `count`");
  } else {
    const TypeId body = Expr(e.args[0]);
    const bool point =
        kind == FoldKind::kSum && types.Is(body, TypeKind::kRecord) && types.Resolve(body) == types.pos();
    if (!types.IsNumeric(body) && !point && !types.Is(body, TypeKind::kError)) {
      auto& report = diagnostics_.Report(Kind::kKoordTypeMismatch, exprs_[e.args[0]].span,
                                         fmt::format("the body of `{}` must be a number", e.text));
      report.Under(fmt::format("this is {}", types.WithArticle(body)));
      // The body reaches as far as it can.
      if (types.Is(body, TypeKind::kBool))
        report.Help(fmt::format("write `({} i in ID: ...) <= 5` with brackets", e.text));
    } else if (kind == FoldKind::kSum || kind == FoldKind::kMin || kind == FoldKind::kMax) {
      result = body;
    }
  }
  may_choose_ = may_choose;
  scope_.resize(depth);
  model_.domains[id] = std::move(domains);
  return result;
}

}  // namespace rondo::koord
