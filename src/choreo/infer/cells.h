#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rondo::choreo {

/// The directions of planes: coefficients of x, y and z.
inline constexpr std::array<std::array<int, 3>, 9> kDirections{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};

/// Some part of what a thread takes up: its extent along each direction, in several states.
struct Extent {
  struct Moment {
    std::array<double, kDirections.size()> least, most;
  };
  size_t thread = 0;
  size_t source = 0;  ///< whatever the caller wants to know of it
  std::vector<Moment> moments;
  /// Only what lies between these counts: the rest is on the other side of a plane.
  std::array<double, kDirections.size()> from, to;

  Extent();
  double Least(size_t direction) const;
  double Most(size_t direction) const;
};

/// One side of a plane: direction . p < offset, or > offset.
struct Side {
  size_t direction = 0;
  double offset = 0;
  bool below = true;
};

using Cell = std::vector<Side>;

struct Cells {
  std::vector<std::vector<Cell>> by_thread;
  /// Two items that nothing separates.
  std::optional<std::pair<Extent, Extent>> conflict;
};

/// Cells without common points, such that all items of a thread are in cells of that thread.
Cells Separate(std::vector<Extent> items, size_t threads);

/// `x - y < 0.3 m and z > 0.1 m or ...`
std::string ToText(const std::vector<Cell>& cells);

/// The offset as it is written: in millimetres at most.
std::string Offset(double offset);

}  // namespace rondo::choreo
