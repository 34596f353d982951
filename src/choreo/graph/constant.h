#pragma once

#include <map>
#include <optional>
#include <string>

#include "expr/rational.h"
#include "lang/syntax_tree.h"
#include "lang/units.h"

namespace rondo::choreo {

/// A number with what it measures, in SI units; or infinity.
struct Quantity {
  expr::Rational value;
  lang::Dimension dimension;
  bool infinite = false;
};

using Environment = std::map<std::string, lang::ExprId, std::less<>>;

/// The value of an expression of literal numbers and of names in `environment`; nullopt if it is not
/// constant, or has no rational value (angles in degrees).
std::optional<Quantity> Constant(const lang::ExprPool& pool, lang::ExprId expr,
                                 const Environment& environment);

}  // namespace rondo::choreo
