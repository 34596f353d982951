#pragma once

#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "expr/numeric.h"

namespace rondo::choreo {

/// A shape to draw, in its colour.
struct Drawn {
  std::string name;
  robot::Shape shape;
  std::string_view fill, stroke;
};

/// The scene in one state, seen from above (x to the right, y up) and from the side (x to the right, z up),
/// with a mark at a point; an SVG picture. Lengths in metres on the axes. Half-spaces are left out.
std::string DrawScene(expr::Arena& arena, const std::vector<Drawn>& shapes, const expr::Numeric::Point& state,
                      const std::optional<std::array<double, 3>>& mark, const std::string& title);

}  // namespace rondo::choreo
