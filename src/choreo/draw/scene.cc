#include "choreo/draw/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "draw/svg.h"
#include "robot/separation/numeric_set.h"

namespace rondo::choreo {
namespace {

using draw::Svg;

constexpr double kSide = 420, kMargin = 48, kTitle = 44;
constexpr int kDirectionCount = 72;

using Outline = std::vector<std::array<double, 2>>;

class Scene {
 public:
  Scene(expr::Arena& arena, const expr::Numeric::Point& state) : arena_(arena), numeric_(arena, state) {}

  // The convex parts of a shape, projected to x and another axis.
  void Outlines(const robot::Shape& shape, int vertical, std::vector<Outline>& outlines) {
    if (shape.kind == robot::ShapeKind::kUnion || shape.kind == robot::ShapeKind::kIntersection) {
      for (const robot::Shape& p : shape.parts) Outlines(p, vertical, outlines);
      return;
    }
    if (shape.kind == robot::ShapeKind::kHalfSpace) return;
    robot::Set set;
    set.solid = shape;
    if (shape.kind == robot::ShapeKind::kHalfSphere) set.solid.kind = robot::ShapeKind::kSphere;
    if (shape.kind == robot::ShapeKind::kPrism && !robot::Corners(arena_, shape)) return;
    const robot::NumericSet solid = robot::Evaluate(arena_, set, numeric_);
    Outline outline;
    for (int k = 0; k < kDirectionCount; ++k) {
      const double angle = 2 * std::numbers::pi * k / kDirectionCount;
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[0] = std::cos(angle);
      d[vertical] = std::sin(angle);
      const Eigen::Vector3d p = solid.FarthestAlong(d);
      if (!p.allFinite()) return;
      outline.push_back({p[0], p[vertical]});
    }
    outlines.push_back(std::move(outline));
  }

 private:
  expr::Arena& arena_;
  expr::Numeric numeric_;
};

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void Add(double x) { low = std::min(low, x), high = std::max(high, x); }
};

/// One of the two views.
class View {
 public:
  View(Svg& svg, double left, const Range& x, const Range& y, double scale)
      : svg_(svg), left_(left), x_(x), y_(y), scale_(scale) {}

  double X(double x) const { return left_ + kMargin + (x - x_.low) * scale_; }
  double Y(double y) const { return kTitle + kSide - kMargin - (y - y_.low) * scale_; }

  void Axes(const std::string& name, const char* vertical) {
    svg_.Text(left_ + kMargin, kTitle - 8, name, Svg::Anchor::kStart, kSide, true);
    const double step = Step();
    for (int k = 0; k * step <= x_.high - Up(x_.low, step) + 1e-9; ++k) {
      const double x = Up(x_.low, step) + k * step;
      svg_.Line(X(x), Y(y_.low), X(x), Y(y_.high), "#e5e5e5");
      svg_.Text(X(x), Y(y_.low) + 14, fmt::format("{:.4g}", Clean(x)), Svg::Anchor::kMiddle, 60);
    }
    for (int k = 0; k * step <= y_.high - Up(y_.low, step) + 1e-9; ++k) {
      const double y = Up(y_.low, step) + k * step;
      svg_.Line(X(x_.low), Y(y), X(x_.high), Y(y), "#e5e5e5");
      svg_.Text(X(x_.low) - 6, Y(y) + 4, fmt::format("{:.4g}", Clean(y)), Svg::Anchor::kEnd, 60);
    }
    svg_.Text(X(x_.high), Y(y_.low) + 28, "x / m", Svg::Anchor::kEnd, 60);
    svg_.Text(X(x_.low) - 6, Y(y_.high) - 6, fmt::format("{} / m", vertical), Svg::Anchor::kEnd, 60);
  }

  void Draw(const Outline& outline, const Drawn& drawn) {
    std::vector<std::array<double, 2>> points;
    for (const auto& [x, y] : outline) points.push_back({X(x), Y(y)});
    svg_.Polygon(points, {drawn.fill, drawn.stroke});
  }

  void Mark(double x, double y) {
    svg_.Line(X(x) - 7, Y(y) - 7, X(x) + 7, Y(y) + 7, "#d00000");
    svg_.Line(X(x) - 7, Y(y) + 7, X(x) + 7, Y(y) - 7, "#d00000");
  }

  // In the middle of the outline, or as near below or above as there is room beside other names.
  void Label(const Outline& outline, const std::string& name) {
    constexpr double kLine = 13, kGap = 4;
    if (name.empty()) return;
    double x = 0, y = 0;
    for (const auto& p : outline) x += X(p[0]) / kDirectionCount, y += Y(p[1]) / kDirectionCount;
    const double width = Svg::WidthOf(name);
    const auto taken = [&](double at) {
      return std::ranges::any_of(labels_, [&](const auto& l) {
        return std::abs(l[0] - x) < (l[2] + width) / 2 + kGap && std::abs(l[1] - at) < kLine;
      });
    };
    double at = y + kGap;
    for (int k = 1; taken(at) && k < 20; ++k) at = y + kGap + (k % 2 == 1 ? (k + 1) / 2 : -k / 2) * kLine;
    labels_.push_back({x, at, width});
    svg_.Text(x, at, name, Svg::Anchor::kMiddle, 120);
  }

 private:
  // The next multiple of `step`.
  static double Up(double v, double step) { return std::ceil(v / step) * step; }
  static double Clean(double v) { return std::abs(v) < 1e-9 ? 0 : v; }
  double Step() const {
    const double rough = std::max(x_.high - x_.low, y_.high - y_.low) / 6;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    for (const double m : {1.0, 2.0, 5.0}) {
      if (m * power >= rough) return m * power;
    }
    return 10 * power;
  }

  Svg& svg_;
  double left_;
  Range x_, y_;
  double scale_;
  std::vector<std::array<double, 3>> labels_;  // places and widths
};

}  // namespace

std::string DrawScene(expr::Arena& arena, const std::vector<Drawn>& shapes, const expr::Numeric::Point& state,
                      const std::optional<std::array<double, 3>>& mark, const std::string& title) {
  Scene scene(arena, state);
  Svg svg;
  std::array<std::vector<std::vector<Outline>>, 2> views;
  Range x;
  std::array<Range, 2> other;
  for (const Drawn& s : shapes) {
    for (size_t v = 0; v < 2; ++v) {
      scene.Outlines(s.shape, static_cast<int>(v) + 1, views[v].emplace_back());
      for (const Outline& o : views[v].back()) {
        for (const auto& [px, py] : o) x.Add(px), other[v].Add(py);
      }
    }
  }
  if (mark) x.Add((*mark)[0]), other[0].Add((*mark)[1]), other[1].Add((*mark)[2]);
  if (!(x.low <= x.high)) x = {0, 1}, other.fill({0, 1});
  double span = x.high - x.low;
  for (const Range& r : other) span = std::max(span, r.high - r.low);
  const double scale = (kSide - 2 * kMargin) / std::max(span, 1e-9);
  svg.Text(kMargin, 16, title, Svg::Anchor::kStart, 2 * kSide - kMargin, true);
  const std::array<const char*, 2> names{"from above", "from the side"}, axes{"y", "z"};
  for (size_t v = 0; v < 2; ++v) {
    View view(svg, static_cast<double>(v) * kSide, x, other[v], scale);
    view.Axes(names[v], axes[v]);
    for (size_t i = 0; i < shapes.size(); ++i) {
      for (const Outline& o : views[v][i]) view.Draw(o, shapes[i]);
    }
    for (size_t i = 0; i < shapes.size(); ++i) {
      if (!views[v][i].empty()) view.Label(views[v][i][0], shapes[i].name);
    }
    if (mark) view.Mark((*mark)[0], (*mark)[v + 1]);
  }
  return svg.Finish(2 * kSide, kTitle + kSide, title);
}

}  // namespace rondo::choreo
