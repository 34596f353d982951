#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Separates sampled sets by planes. Nothing here is trusted by proofs: what is found is proved afterwards.
namespace rondo::choreo {

/// Lists the directions of planes: coefficients of x, y and z in the world frame.
inline constexpr std::array<std::array<int, 3>, 9> kDirections{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};

/// Describes some part of what a thread takes up: its extent along each direction, in several states.
struct Extent {
  /// Holds the least and the largest value along each direction, in one state.
  struct Moment {
    std::array<double, kDirections.size()> least, most;
  };
  size_t thread = 0;
  size_t source = 0;  ///< whatever the caller wants to know of it
  std::vector<Moment> moments;
  /// Bounds the part that counts, along each direction: the rest is on the other side of a plane.
  std::array<double, kDirections.size()> from, to;

  Extent();
  /// Returns the least and the largest value along a direction over all moments, within the bounds.
  double Least(size_t direction) const;
  double Most(size_t direction) const;
};

/// Represents one side of a plane: direction . p < offset, or > offset; p in metres, world frame.
struct Side {
  size_t direction = 0;
  double offset = 0;
  bool below = true;
};

/// Represents the points that are on all of these sides.
using Cell = std::vector<Side>;

/// Holds the cells of each thread, or why there are none.
struct Cells {
  std::vector<std::vector<Cell>> by_thread;
  /// Holds two items that no plane separates, if there are such; then the cells are not complete.
  std::optional<std::pair<Extent, Extent>> conflict;
};

/// Returns cells without common points, such that all items of a thread are in cells of that thread.
Cells Separate(std::vector<Extent> items, size_t threads);

/// Returns cells as a region in source: `x - y < 0.3 m and z > 0.1 m or ...`.
std::string ToText(const std::vector<Cell>& cells);

/// Returns an offset, in metres, as it is written in source: with four decimals at most.
std::string Offset(double offset);

}  // namespace rondo::choreo
