#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "draw/svg.h"
#include "draw/ticks.h"
#include "sim/draw/plots.h"

namespace rondo::sim {
namespace {

using draw::Svg;

constexpr double kLeft = 56, kTop = 52, kWidth = 640, kHeight = 220, kBelow = 40;  // pixels
constexpr const char* kRobots = "#1f77b4";
constexpr const char* kObstacles = "#2ca02c";
constexpr const char* kContact = "#d62728";
constexpr const char* kGrid = "#e4e4e4";
constexpr const char* kAxis = "#888888";

// Times in seconds, distances in metres; bodies that overlap have none.
struct Distances {
  std::vector<std::array<double, 2>> between_robots;
  std::vector<std::array<double, 2>> to_obstacles;
  double end = 0;
  double most = 0;
};

Distances DistancesOf(const History& history, const World& world) {
  Distances distances;
  if (history.robots.empty()) return distances;
  size_t samples = std::numeric_limits<size_t>::max();
  for (const auto& robot : history.robots) samples = std::min(samples, robot.poses.size());
  const auto add = [&](std::vector<std::array<double, 2>>& line, double time, double distance) {
    if (!std::isfinite(distance)) return;
    line.push_back({time, std::max(0.0, distance)});
    distances.most = std::max(distances.most, distance);
  };
  for (size_t i = 0; i < samples; ++i) {
    double between = std::numeric_limits<double>::infinity();
    double near = std::numeric_limits<double>::infinity();
    for (size_t a = 0; a < history.robots.size(); ++a) {
      const Point& p = history.robots[a].poses[i].second;
      near = std::min(near, world.DistanceTo(p) - history.robots[a].radius);
      for (size_t b = 0; b < a; ++b) {
        between = std::min(between, Distance(p, history.robots[b].poses[i].second) -
                                        history.robots[a].radius - history.robots[b].radius);
      }
    }
    const double time = history.robots[0].poses[i].first;
    distances.end = std::max(distances.end, time);
    add(distances.between_robots, time, between);
    add(distances.to_obstacles, time, near);
  }
  return distances;
}

}  // namespace

std::string DrawDistances(const History& history, const World& world) {
  const Distances distances = DistancesOf(history, world);
  const double end = std::max(distances.end, 1e-9);
  const double top = distances.most > 0 ? distances.most * 1.05 : 1;
  const auto x = [&](double seconds) { return kLeft + seconds / end * kWidth; };
  const auto y = [&](double metres) { return kTop + kHeight * (1 - metres / top); };
  Svg svg;
  for (const double tick : draw::Ticks(0, end, 9)) {
    svg.Line(x(tick), y(0), x(tick), y(top), kGrid);
    svg.Text(x(tick), y(0) + 15, fmt::format("{:.4g}", tick), Svg::Anchor::kMiddle, kLeft);
  }
  for (const double tick : draw::Ticks(0, top, 7)) {
    svg.Line(x(0), y(tick), x(end), y(tick), kGrid);
    svg.Text(x(0) - 5, y(tick) + 4, fmt::format("{:.4g}", tick), Svg::Anchor::kEnd, kLeft);
  }
  svg.Rect(kLeft, kTop, kWidth, kHeight, {.stroke = kAxis});
  svg.Line(x(0), y(0), x(end), y(0), kContact, true);
  svg.Text(kLeft + kWidth / 2, kTop + kHeight + 30, "time [s]", Svg::Anchor::kMiddle, kWidth);
  svg.Text(kLeft - 5, kTop - 8, "distance [m]", Svg::Anchor::kMiddle, 2 * kLeft);

  double left = kLeft + 60;
  const auto curve = [&](const std::vector<std::array<double, 2>>& points, const char* colour,
                         const char* name) {
    if (points.empty()) return;
    std::vector<std::array<double, 2>> line;
    for (const auto& [time, distance] : points) line.push_back({x(time), y(distance)});
    svg.Polyline(line, colour, 1.5);
    svg.Polyline({{left, kTop - 12}, {left + 18, kTop - 12}}, colour, 3);
    svg.Text(left + 24, kTop - 8, name, Svg::Anchor::kStart, kWidth, false, colour);
    left += 50 + Svg::WidthOf(name);
  };
  curve(distances.between_robots, kRobots, "least distance of two robots");
  curve(distances.to_obstacles, kObstacles, "of a robot and an obstacle");
  svg.Line(left, kTop - 12, left + 18, kTop - 12, kContact, true);
  svg.Text(left + 24, kTop - 8, "contact", Svg::Anchor::kStart, kWidth, false, kContact);

  const std::string title = TitleOf(history);
  svg.Text(kLeft, 20, title, Svg::Anchor::kStart, kWidth, true);
  return svg.Finish(kLeft + kWidth + 24, kTop + kHeight + kBelow, title);
}

}  // namespace rondo::sim
