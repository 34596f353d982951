#pragma once

#include <optional>
#include <vector>

#include "robot/values/shape.h"

/// States the question whether shapes can meet.
namespace rondo::robot {

/// Holds the question whether bodies can meet: is there a state and a point of the world, so that
/// `configuration` holds, all `shapes` contain the point, `where` holds there, and `beyond` does not contain
/// it?
struct Meeting {
  TermId configuration;       ///< about the state; not about the point
  std::vector<Shape> shapes;  ///< at least one
  TermId where;               ///< about the point and the state: outside of a region; true if there is none
  std::optional<Shape> beyond;
};

/// Returns the question as one formula over the state and the point, which has a solution exactly if they
/// can.
TermId Formula(Arena& arena, const Vector& point, const Meeting& meeting);

/// Returns the question with the point in coordinates of the frame of the first shape, where the shape bounds
/// it: one formula for each convex part of that shape. The meeting is possible if one of them has a solution.
std::vector<TermId> LocalFormulas(Arena& arena, const Vector& point, const Meeting& meeting);

/// Returns a condition under which the first shape lies within the second, because their parts stand in the
/// same frame: comparisons of sizes. Sufficient, not necessary; false if nothing can be said.
TermId Within(Arena& arena, const Shape& inner, const Shape& outer);

/// Returns where some part of a shape has no value.
TermId Undefined(Arena& arena, const Shape& shape);

/// Returns where a shape may have no points, as far as sizes tell, or some part of it has no value.
TermId MayBeEmpty(Arena& arena, const Shape& shape);

}  // namespace rondo::robot
