#pragma once

#include <optional>
#include <vector>

#include "expr/numeric.h"
#include "robot/separation/meeting.h"

/// Represents convex sets, of which shapes are made.
namespace rondo::robot {

/// Names the kinds of sets.
enum class SetKind : uint8_t {
  kSolid,    ///< a bounded shape that is no union
  kBelow,    ///< a half-space: normal . p <= bound
  kBall,     ///< points whose distance to `centre`, along `axes`, is at most the root of `bound`
  kOutside,  ///< points whose distance is at least that; not convex
};

/// Represents a set of points of the world, given by terms over the state; metres.
struct Set {
  SetKind kind = SetKind::kSolid;
  Shape solid;
  Vector normal;                         ///< kBelow
  TermId bound;                          ///< kBelow, kBall, kOutside
  bool open = false;                     ///< the boundary does not belong to it
  Vector centre;                         ///< kBall, kOutside
  std::array<bool, 3> axes = {1, 1, 1};  ///< kBall, kOutside
};

/// Represents the points that are in all of these sets.
using Piece = std::vector<Set>;

/// Returns pieces whose union contains every point of the meeting. Conditions that are none of the sets above
/// are left out, so that a piece may be larger than what it stands for. Nothing, if there are more than
/// `most` of them.
std::optional<std::vector<Piece>> PiecesOf(Arena& arena, const Vector& point, const Meeting& meeting,
                                           size_t most);

/// Returns the corners of a prism in its plane, as terms over its faces, if these go around once, as numbers
/// show. The prism lies within their hull.
std::optional<std::vector<std::array<TermId, 2>>> Corners(Arena& arena, const Shape& prism);

}  // namespace rondo::robot
