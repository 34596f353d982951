#include "sim/draw/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "draw/svg.h"

namespace rondo::sim {
namespace {

using draw::Svg;

constexpr double kMargin = 56, kLongest = 640;  // pixels
constexpr double kHeadline = 20;                // the base of the first line of text
constexpr size_t kMostNames = 40;
constexpr const char* kColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                    "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};
constexpr const char* kWall = "#888888";
constexpr const char* kTouch = "red";

const char* Colour(size_t i) { return kColours[i % std::size(kColours)]; }

// A rectangle of the world, in metres.
struct Area {
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
  void Add(double x, double y) {
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
};

Area AreaOf(const History& history, const World& world) {
  Area area;
  for (const auto& robot : history.robots) {
    for (const auto& [t, p] : robot.poses) area.Add(p[0], p[1]);
  }
  for (const Box& box : world.boxes) {
    area.Add(box.centre[0] - box.size[0] / 2, box.centre[1] - box.size[1] / 2);
    area.Add(box.centre[0] + box.size[0] / 2, box.centre[1] + box.size[1] / 2);
  }
  for (const Cylinder& c : world.cylinders) {
    area.Add(c.centre[0] - c.radius, c.centre[1] - c.radius);
    area.Add(c.centre[0] + c.radius, c.centre[1] + c.radius);
  }
  const trace::Grid& map = history.map;
  if (!map.cells.empty()) {
    const auto size = static_cast<double>(map.resolution);
    area.Add(map.origin[0], map.origin[1]);
    area.Add(map.origin[0] + map.width * size, map.origin[1] + map.height * size);
  }
  if (area.x0 > area.x1) return {0, 0, 1, 1};
  const double pad = 0.5 + 0.02 * std::max(area.x1 - area.x0, area.y1 - area.y0);
  return {area.x0 - pad, area.y0 - pad, area.x1 + pad, area.y1 + pad};
}

// The world from above, y upwards.
class Above {
 public:
  Above(const History& history, const World& world)
      : history_(history),
        world_(world),
        area_(AreaOf(history, world)),
        scale_(kLongest / std::max(area_.x1 - area_.x0, area_.y1 - area_.y0)) {}

  void Map() {
    const trace::Grid& map = history_.map;
    const auto size = static_cast<double>(map.resolution);
    for (uint32_t r = 0; r < map.height; ++r) {
      for (uint32_t c = 0; c < map.width; ++c) {
        const int8_t cell = map.cells[static_cast<size_t>(r) * map.width + c];
        const char* fill = cell < 0 ? "#f3e3b5" : cell == 0 ? "white" : "#555555";
        Rect(map.origin[0] + c * size, map.origin[1] + r * size, size, size,
             {.fill = fill, .stroke = "#dddddd", .width = 0.5});
      }
    }
  }

  void Obstacles(const Svg::Style& style) {
    for (const Box& b : world_.boxes)
      Rect(b.centre[0] - b.size[0] / 2, b.centre[1] - b.size[1] / 2, b.size[0], b.size[1], style);
    for (const Cylinder& c : world_.cylinders)
      svg_.Circle(X(c.centre[0]), Y(c.centre[1]), c.radius * scale_, style);
  }

  void Routes(double width) {
    for (size_t r = 0; r < history_.robots.size(); ++r) {
      const auto& robot = history_.robots[r];
      if (robot.poses.empty()) continue;
      std::vector<std::array<double, 2>> line;
      for (const auto& [t, p] : robot.poses) line.push_back({X(p[0]), Y(p[1])});
      svg_.Polyline(line, Colour(r), width, 0.8);
      const double size = std::max(3.0, robot.radius * scale_);
      svg_.Circle(line.front()[0], line.front()[1], size, {.stroke = Colour(r)});
      svg_.Circle(line.back()[0], line.back()[1], size, {.fill = Colour(r), .opacity = 0.5});
      if (history_.robots.size() <= kMostNames)
        svg_.Text(line.back()[0] + size, line.back()[1] - size, robot.name, Svg::Anchor::kStart, kLongest,
                  false, Colour(r));
    }
  }

  void Touches() {
    for (const auto& [time, event] : history_.events) {
      if (TextOf(event, "event") != "collision") continue;
      for (const auto& robot : history_.robots) {
        if (robot.name != TextOf(event, "robot") || robot.poses.empty()) continue;
        const Point p = PositionAt(robot, time);
        svg_.Circle(X(p[0]), Y(p[1]), 7, {.stroke = kTouch, .width = 2});
      }
    }
  }

  std::string Finish(const std::string& legend) {
    ScaleBar();
    const double width = std::max((area_.x1 - area_.x0) * scale_ + 2 * kMargin, kLongest);
    const std::string title = TitleOf(history_);
    svg_.Text(kMargin + 80, kHeadline, title + "; " + legend, Svg::Anchor::kStart, width - kMargin - 90);
    return svg_.Finish(width, (area_.y1 - area_.y0) * scale_ + 2 * kMargin, title);
  }

 private:
  double X(double x) const { return kMargin + (x - area_.x0) * scale_; }
  double Y(double y) const { return kMargin + (area_.y1 - y) * scale_; }
  void Rect(double x, double y, double w, double h, const Svg::Style& style) {
    svg_.Rect(X(x), Y(y + h), w * scale_, h * scale_, style);
  }

  // One metre, or ten or a hundred of them, as a bar.
  void ScaleBar() {
    double metres = 1;
    while (metres * scale_ < 40) metres *= 10;
    svg_.Polyline({{kMargin, kHeadline + 8}, {kMargin + metres * scale_, kHeadline + 8}}, "black", 2);
    svg_.Text(kMargin, kHeadline, fmt::format("{:g} m", metres), Svg::Anchor::kStart, 80);
  }

  // Where was the robot at this time?
  static Point PositionAt(const History::Robot& robot, double time) {
    const auto it = std::lower_bound(robot.poses.begin(), robot.poses.end(), time,
                                     [](const auto& pose, double t) { return pose.first < t; });
    return it == robot.poses.end() ? robot.poses.back().second : it->second;
  }

  const History& history_;
  const World& world_;
  Area area_;
  double scale_;  // pixels per metre
  Svg svg_;
};

}  // namespace

std::string DrawPaths(const History& history, const World& world) {
  Above above(history, world);
  above.Obstacles({.fill = "#bbbbbb", .stroke = kWall});
  above.Routes(1.5);
  above.Touches();
  return above.Finish("circles: start, discs: end");
}

std::string DrawMap(const History& history, const World& world) {
  Above above(history, world);
  above.Map();
  above.Obstacles({.stroke = "#d62728"});
  above.Routes(1);
  return above.Finish("dark: occupied, white: empty, yellow: unknown; red: obstacles");
}

}  // namespace rondo::sim
