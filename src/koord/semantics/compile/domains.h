#pragma once

#include <vector>

#include "koord/check/model.h"

/// Says what the variables of quantifiers run over when programs are executed.
namespace rondo::koord::semantics {

/// Is one variable of a quantifier.
struct Bound {
  uint32_t binding;
  DomainKind kind;
  ExprId list;  ///< whose items it is, for `DomainKind::kList`
};

/// Returns the variables of a quantifier in the order in which they are gone through: ints last, since what bounds them may
/// mention the others.
std::vector<Bound> BoundsOf(const Model& model, ExprId quantifier);

/// Is a limit of an int: the value of an expression and a number.
struct Limit {
  ExprId value;
  int64_t plus;
};

/// Holds limits of an int, each of which counts: it is at least each `lower` one, and less than each `upper` one.
struct Limits {
  std::vector<Limit> lower, upper;
};

/// Returns the limits of variable `i` of `all`, an int, that follow from what the quantifier supposes and that can be evaluated
/// once the variables before it have values.
Limits LimitsOf(const Model& model, const std::vector<Bound>& all, size_t i, ExprId body, bool forall);

}  // namespace rondo::koord::semantics
