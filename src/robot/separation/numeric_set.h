#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot/separation/set.h"

namespace rondo::robot {

/// A set at one configuration, in doubles.
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

  /// A point of a solid or a ball that lies farthest along `d`.
  Eigen::Vector3d FarthestAlong(const Eigen::Vector3d& d) const;
  /// Some point in the middle.
  Eigen::Vector3d Middle() const;
};

NumericSet Evaluate(Arena& arena, const Set& set, expr::Numeric& numeric);

/// Directions for each set, which sum to 0; multiples of the normals for half-spaces.
struct Separation {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> factors;  ///< of the normals
  double sum = 0;               ///< of the support functions: negative if the sets are apart
  double length = 0;            ///< of the longest direction
  Eigen::Vector3d point;        ///< of the first set, where it is closest
};

/// The sum for given directions.
void Complete(const std::vector<NumericSet>& sets, size_t first, Separation& separation);

/// Looks for the best directions by subgradient descent. `first`: a solid, whose direction balances the
/// others.
Separation Separate(const std::vector<NumericSet>& sets, size_t first);

}  // namespace rondo::robot
