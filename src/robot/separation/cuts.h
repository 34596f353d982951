#pragma once

#include <vector>

#include "robot/separation/support.h"

/// Finds conditions on the state under which sets have no common point (docs/theory.md, "Separation").
namespace rondo::robot {

/// Holds what is known of the sets of a piece at one configuration.
struct Cut {
  /// Lists conditions on the state that hold wherever the sets have a common point, and not at the
  /// configuration: the sets are apart there. Empty if nothing was found.
  std::vector<TermId> conditions;
  /// Says how far apart the sets are there at least, as far as numbers tell, in metres; negative: they
  /// overlap.
  double apart = 0;
};

/// Finds separating directions for the sets of one piece. If directions d_i of the sets sum to 0, and the
/// sums of their support functions are below 0, then the sets have no common point: a common point p would
/// give 0 = sum d_i . p <= sum Support(set_i, d_i) < 0. So `sum Support(set_i, d_i) >= 0`, over the state
/// alone, holds wherever they meet (and > 0, if the boundary of one of them does not belong to it).
class Cuts {
 public:
  Cuts(Arena& arena, Piece piece);

  /// Returns conditions that need no configuration: solids within what lies outside of a ball.
  std::vector<TermId> Common();

  /// Looks for directions that separate the sets at `configuration`, in doubles; the conditions are exact,
  /// whatever was found.
  Cut At(const expr::Numeric::Point& configuration);

 private:
  Arena& arena_;
  Piece piece_;
  /// Boxes and prisms within cylinders around their axes, so that it does not matter how they are turned;
  /// empty if there are none.
  Piece round_;
};

}  // namespace rondo::robot
