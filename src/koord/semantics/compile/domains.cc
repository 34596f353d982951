#include "koord/semantics/compile/domains.h"

#include <algorithm>

#include "lang/expr_queries.h"

namespace rondo::koord::semantics {

using lang::ExprKind;
using lang::TypeKind;

namespace {

bool Mentions(const Model& model, ExprId id, const std::vector<uint32_t>& bindings) {
  const lang::Expr& e = model.program->exprs[id];
  const Ref ref = model.RefOf(id);
  if (ref.kind == RefKind::kBinding &&
      std::find(bindings.begin(), bindings.end(), ref.index) != bindings.end())
    return true;
  return std::any_of(e.args.begin(), e.args.end(), [&](ExprId a) { return Mentions(model, a, bindings); });
}

/// Finds limits of ints in conditions.
class Finder {
 public:
  Finder(const Model& model, std::vector<ExprId> conditions, std::vector<uint32_t> unbound)
      : model_(model),
        exprs_(model.program->exprs),
        conditions_(std::move(conditions)),
        unbound_(std::move(unbound)) {}

  std::vector<Limit> Of(uint32_t binding, bool upper) {
    limits_.clear();
    seen_.clear();
    Find(binding, upper);
    return limits_;
  }

 private:
  // Does it have a value wherever it stands? Sums may overflow, and items be none.
  bool CannotFail(ExprId id) const {
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
  void Find(uint32_t binding, bool upper) {
    if (std::find(seen_.begin(), seen_.end(), binding) != seen_.end()) return;
    seen_.push_back(binding);
    // Conditions are asked one after the other: only those at the front, which bound variables, are always.
    bool first = true;
    for (const ExprId id : conditions_) {
      const lang::Expr& e = exprs_[id];
      first =
          first && e.kind == ExprKind::kBinary && (e.text[0] == '<' || e.text[0] == '>' || e.text == "==") &&
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
        if (!model_.types.Is(model_.TypeOf(other), TypeKind::kInt) || (!first && !CannotFail(other)))
          continue;
        const bool strict = e.text.size() == 1;
        // Half-open: from the lower limit up to, not including, the upper one.
        const int64_t plus = upper ? (strict ? 0 : 1) : (strict ? 1 : 0);
        const Ref to = model_.RefOf(other);
        if (!Mentions(model_, other, unbound_)) {
          limits_.push_back({other, plus});
        } else if (to.kind == RefKind::kBinding && to.index != binding) {
          Find(to.index, upper);
        }
      }
    }
  }

  const Model& model_;
  const lang::ExprPool& exprs_;
  std::vector<ExprId> conditions_;
  std::vector<uint32_t> unbound_;  // the variables without a value so far
  std::vector<uint32_t> seen_;
  std::vector<Limit> limits_;
};

}  // namespace

std::vector<Bound> BoundsOf(const Model& model, ExprId quantifier) {
  const lang::Expr& e = model.program->exprs[quantifier];
  const Model::Domains& domains = model.domains.at(quantifier);
  std::vector<Bound> all;
  for (size_t b = 0; b < e.binders.size(); ++b) {
    for (const uint32_t binding : domains.bindings[b])
      all.push_back({binding, domains.kinds[b], e.binders[b].domain});
  }
  // Ints last: what bounds them may mention the others.
  std::vector<uint32_t> ints;
  for (const Bound& b : all) {
    if (b.kind == DomainKind::kType && model.types.Is(model.bindings[b.binding].type, TypeKind::kInt))
      ints.push_back(b.binding);
  }
  const bool lists = std::any_of(all.begin(), all.end(), [&](const Bound& b) {
    return b.kind == DomainKind::kList && Mentions(model, b.list, ints);
  });
  if (!lists) {
    std::stable_partition(all.begin(), all.end(), [&](const Bound& b) {
      return std::find(ints.begin(), ints.end(), b.binding) == ints.end();
    });
  }
  return all;
}

Limits LimitsOf(const Model& model, const std::vector<Bound>& all, size_t i, ExprId body, bool forall) {
  // forall x: A implies B asks for the x with A only, exists x: A for those with A.
  std::vector<uint32_t> unbound;
  for (size_t k = i; k < all.size(); ++k) unbound.push_back(all[k].binding);
  Finder finder(model, lang::SuppositionsOf(model.program->exprs, body, forall), std::move(unbound));
  return {finder.Of(all[i].binding, false), finder.Of(all[i].binding, true)};
}

}  // namespace rondo::koord::semantics
