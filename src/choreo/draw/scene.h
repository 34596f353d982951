#pragma once

#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "expr/numeric.h"

/// Draws shapes of robots and obstacles in one state.
namespace rondo::choreo {

/// Holds a shape to draw, its name, and the SVG colours of its inside and its edge.
struct Drawn {
  std::string name;
  robot::Shape shape;
  std::string_view fill, stroke;
};

/// Returns the scene in one state as an SVG picture: seen from above (x to the right, y up) and from the side
/// (x to the right, z up), with a mark at a point of the world frame. The axes show metres. Half-spaces are
/// left out.
std::string DrawScene(expr::Arena& arena, const std::vector<Drawn>& shapes, const expr::Numeric::Point& state,
                      const std::optional<std::array<double, 3>>& mark, const std::string& title);

}  // namespace rondo::choreo
