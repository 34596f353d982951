#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot/separation/set.h"

/// Searches for separating directions in doubles. Nothing here is trusted: what is found is stated exactly
/// and proved.
namespace rondo::robot {

/// Holds a set at one configuration, in doubles; metres.
struct NumericSet {
  SetKind kind = SetKind::kSolid;
  ShapeKind shape = ShapeKind::kSphere;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  std::vector<double> sizes;
  std::vector<Eigen::Vector2d> corners;
  Eigen::Vector3d normal;
  double bound = 0;
  std::array<bool, 3> axes{};

  /// Returns a point of a solid or a ball that lies farthest along `d`, in the world frame.
  Eigen::Vector3d FarthestAlong(const Eigen::Vector3d& d) const;
  /// Returns a point in the middle of a solid or a ball: half-way between its ends along its z axis; the
  /// centre of a ball.
  Eigen::Vector3d Middle() const;
};

/// Returns the set at the configuration of `numeric`.
NumericSet Evaluate(Arena& arena, const Set& set, expr::Numeric& numeric);

/// Holds directions for each set, which sum to 0; multiples of the normals for half-spaces.
struct Separation {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> factors;  ///< of half-spaces: the multiples of their normals, not negative
  double sum = 0;               ///< of the support functions: negative if the sets are apart
  double length = 0;            ///< that of the longest direction but the first set's
  Eigen::Vector3d point;        ///< the point of the first set that is closest to the others
};

/// Completes given directions: sets the direction of set `first` so that all sum to 0, and the sum of the
/// support functions.
void Complete(const std::vector<NumericSet>& sets, size_t first, Separation& separation);

/// Looks for the best directions by subgradient descent, 600 steps.
/// @param first  a solid, whose direction balances the others.
Separation Separate(const std::vector<NumericSet>& sets, size_t first);

}  // namespace rondo::robot
