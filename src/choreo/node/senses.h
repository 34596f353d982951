#pragma once

#include <vector>

#include "choreo/graph/graph.h"
#include "expr/numeric.h"

/// Runs processes and local types by interpretation, behind the interface of sessions.
namespace rondo::choreo {

/// Tells a robot what it needs to know to act.
class Senses {
 public:
  virtual ~Senses() = default;
  /// Returns the values of everything that the robot can know by itself now: states, inputs, environment.
  virtual const expr::Numeric::Point& Now() = 0;
  /// Returns one of `count` alternatives that are all possible.
  virtual size_t Pick(size_t count) = 0;
  /// Returns values for the payload of a message that only says what is known of it (SI units, in the order of its terms);
  /// nothing if there are none.
  virtual std::optional<std::vector<double>> Choose(const Node& message) = 0;
};

/// Is what rounding may make of a comparison that holds: guards are true up to this, if none is true without it (SI units).
inline constexpr double kRounding = 1e-7;

/// Returns the values of terms in a state: of formulas 0 or 1. Nothing if one has no value.
std::optional<std::vector<double>> ValuesOf(const expr::Arena& arena, const std::vector<robot::Value>& values,
                                            const expr::Numeric::Point& state);

}  // namespace rondo::choreo
