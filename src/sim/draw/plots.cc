#include "sim/draw/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondo::sim {
namespace {

constexpr const char* kColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                    "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};
const char* Colour(size_t i) { return kColours[i % std::size(kColours)]; }

std::string Escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

// A picture of a rectangle of the world, or of a diagram.
class Canvas {
 public:
  Canvas(double x0, double y0, double x1, double y1, double width, double height)
      : x0_(x0), y1_(y1), sx_((width - 2 * kMargin) / (x1 - x0)), sy_((height - 2 * kMargin) / (y1 - y0)) {
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"0 0 {:.0f} {:.0f}\" "
        "font-family=\"sans-serif\" font-size=\"11\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height, width, height);
  }
  double X(double x) const { return kMargin + (x - x0_) * sx_; }
  double Y(double y) const { return kMargin + (y1_ - y) * sy_; }
  double Scale() const { return sx_; }
  void Rect(double x, double y, double w, double h, const std::string& style) {
    out_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", X(x),
                        Y(y + h), w * sx_, h * sy_, style);
  }
  void Circle(double x, double y, double pixels, const std::string& style) {
    out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", X(x), Y(y), pixels, style);
  }
  void Line(const std::vector<std::pair<double, double>>& points, const std::string& style) {
    if (points.empty()) return;
    out_ += "<polyline fill=\"none\" points=\"";
    double px = 1e300;
    double py = 1e300;
    for (size_t i = 0; i < points.size(); ++i) {
      const double x = X(points[i].first);
      const double y = Y(points[i].second);
      // Nobody sees less than half a pixel.
      if (std::hypot(x - px, y - py) < 0.5 && i + 1 < points.size()) continue;
      out_ += fmt::format("{:.1f},{:.1f} ", x, y);
      px = x;
      py = y;
    }
    out_ += "\" " + style + "/>\n";
  }
  void Text(double x, double y, const std::string& text, const std::string& style = "") {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", X(x), Y(y), style, Escaped(text));
  }
  void Raw(double px, double py, const std::string& text, const std::string& style = "") {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", px, py, style, Escaped(text));
  }
  void Bar(double pixels, const std::string& text) {
    out_ += fmt::format("<path d=\"M{:.1f} 28 h{:.1f}\" stroke=\"black\" stroke-width=\"2\"/>\n", kMargin,
                        pixels);
    Raw(kMargin, 20, text);
  }
  std::string Take() { return out_ + "</svg>\n"; }
  static constexpr double kMargin = 56;

 private:
  double x0_, y1_, sx_, sy_;
  std::string out_;
};

struct Bounds {
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
  void Add(double x, double y) {
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
};

Canvas Above(const History& history, const World& world) {
  Bounds b;
  for (const auto& robot : history.robots) {
    for (const auto& [t, p] : robot.poses) b.Add(p[0], p[1]);
  }
  for (const Box& box : world.boxes) {
    b.Add(box.centre[0] - box.size[0] / 2, box.centre[1] - box.size[1] / 2);
    b.Add(box.centre[0] + box.size[0] / 2, box.centre[1] + box.size[1] / 2);
  }
  for (const Cylinder& c : world.cylinders) {
    b.Add(c.centre[0] - c.radius, c.centre[1] - c.radius);
    b.Add(c.centre[0] + c.radius, c.centre[1] + c.radius);
  }
  if (!history.map.cells.empty()) {
    b.Add(history.map.origin[0], history.map.origin[1]);
    b.Add(history.map.origin[0] + history.map.width * static_cast<double>(history.map.resolution),
          history.map.origin[1] + history.map.height * static_cast<double>(history.map.resolution));
  }
  if (b.x0 > b.x1) b = {0, 0, 1, 1};
  const double pad = 0.5 + 0.02 * std::max(b.x1 - b.x0, b.y1 - b.y0);
  const double w = b.x1 - b.x0 + 2 * pad;
  const double h = b.y1 - b.y0 + 2 * pad;
  const double scale = 640 / std::max(w, h);
  Canvas canvas(b.x0 - pad, b.y0 - pad, b.x1 + pad, b.y1 + pad, w * scale + 2 * Canvas::kMargin,
                h * scale + 2 * Canvas::kMargin);
  return canvas;
}

void Obstacles(Canvas& canvas, const World& world, const std::string& style) {
  for (const Box& b : world.boxes)
    canvas.Rect(b.centre[0] - b.size[0] / 2, b.centre[1] - b.size[1] / 2, b.size[0], b.size[1], style);
  for (const Cylinder& c : world.cylinders)
    canvas.Circle(c.centre[0], c.centre[1], c.radius * canvas.Scale(), style);
}

// One metre, or ten or a hundred of them, as a bar.
void ScaleBar(Canvas& canvas) {
  double metres = 1;
  while (metres * canvas.Scale() < 40) metres *= 10;
  canvas.Bar(metres * canvas.Scale(), fmt::format("{:g} m", metres));
}

void Routes(Canvas& canvas, const History& history, bool thin) {
  for (size_t r = 0; r < history.robots.size(); ++r) {
    const auto& robot = history.robots[r];
    std::vector<std::pair<double, double>> line;
    for (const auto& [t, p] : robot.poses) line.emplace_back(p[0], p[1]);
    canvas.Line(line,
                fmt::format("stroke=\"{}\" stroke-width=\"{}\" opacity=\"0.8\"", Colour(r), thin ? 1 : 1.5));
    if (line.empty()) continue;
    const double size = std::max(3.0, robot.radius * canvas.Scale());
    canvas.Circle(line.front().first, line.front().second, size,
                  fmt::format("fill=\"none\" stroke=\"{}\"", Colour(r)));
    canvas.Circle(line.back().first, line.back().second, size,
                  fmt::format("fill=\"{}\" fill-opacity=\"0.5\"", Colour(r)));
    if (history.robots.size() <= 40)
      canvas.Text(line.back().first + robot.radius, line.back().second + robot.radius, robot.name,
                  fmt::format("fill=\"{}\"", Colour(r)));
  }
}

// Where was the robot at this time?
Point PositionAt(const History::Robot& robot, double time) {
  const auto it = std::lower_bound(robot.poses.begin(), robot.poses.end(), time,
                                   [](const auto& pose, double t) { return pose.first < t; });
  return it == robot.poses.end() ? robot.poses.back().second : it->second;
}

void Touches(Canvas& canvas, const History& history) {
  for (const auto& [time, event] : history.events) {
    if (TextOf(event, "event") != "collision") continue;
    for (const auto& robot : history.robots) {
      if (robot.name != TextOf(event, "robot") || robot.poses.empty()) continue;
      const Point p = PositionAt(robot, time);
      canvas.Circle(p[0], p[1], 7, "fill=\"none\" stroke=\"red\" stroke-width=\"2\"");
    }
  }
}

std::string Title(const History& history) {
  return fmt::format("{}, {} robots, seed {}", TextOf(history.run, "program_name"), history.robots.size(),
                     history.run.contains("seed") ? history.run["seed"].dump() : "?");
}

}  // namespace

std::string DrawPaths(const History& history, const World& world) {
  Canvas canvas = Above(history, world);
  Obstacles(canvas, world, "fill=\"#bbbbbb\" stroke=\"#888888\"");
  Routes(canvas, history, false);
  Touches(canvas, history);
  ScaleBar(canvas);
  canvas.Raw(Canvas::kMargin + 80, 20, Title(history) + "; circles: start, discs: end");
  return canvas.Take();
}

std::string DrawMap(const History& history, const World& world) {
  Canvas canvas = Above(history, world);
  const trace::Grid& map = history.map;
  const double size = map.resolution;
  for (uint32_t r = 0; r < map.height; ++r) {
    for (uint32_t c = 0; c < map.width; ++c) {
      const int8_t cell = map.cells[static_cast<size_t>(r) * map.width + c];
      canvas.Rect(
          map.origin[0] + c * size, map.origin[1] + r * size, size, size,
          fmt::format("fill=\"{}\" stroke=\"#dddddd\" stroke-width=\"0.5\"", cell < 0    ? "#f3e3b5"
                                                                             : cell == 0 ? "white"
                                                                                         : "#555555"));
    }
  }
  Obstacles(canvas, world, "fill=\"none\" stroke=\"#d62728\"");
  Routes(canvas, history, true);
  ScaleBar(canvas);
  canvas.Raw(Canvas::kMargin + 80, 20,
             Title(history) + "; dark: occupied, white: empty, yellow: unknown; red: obstacles");
  return canvas.Take();
}

std::string DrawDistances(const History& history, const World& world) {
  std::vector<std::pair<double, double>> robots;
  std::vector<std::pair<double, double>> obstacles;
  size_t samples = std::numeric_limits<size_t>::max();
  for (const auto& robot : history.robots) samples = std::min(samples, robot.poses.size());
  if (history.robots.empty()) samples = 0;
  double most = 0;
  double end = 1e-9;
  for (size_t i = 0; i < samples; ++i) {
    const double t = history.robots[0].poses[i].first;
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
    end = std::max(end, t);
    if (std::isfinite(between)) robots.emplace_back(t, between);
    if (std::isfinite(near)) obstacles.emplace_back(t, near);
    if (std::isfinite(between)) most = std::max(most, between);
    if (std::isfinite(near)) most = std::max(most, near);
  }
  const double top = most > 0 ? most * 1.05 : 1;
  Canvas canvas(0, std::min(0.0, -0.05 * top), end, top, 720, 320);
  canvas.Line({{0, 0}, {end, 0}}, "stroke=\"#d62728\" stroke-dasharray=\"4 3\"");
  canvas.Line({{0, 0}, {0, top}}, "stroke=\"#444444\"");
  for (int k = 0; k <= 4; ++k) {
    const double x = end * k / 4;
    const double y = top * k / 4;
    canvas.Text(x, -0.05 * top, fmt::format("{:.4g} s", x), "text-anchor=\"middle\" dy=\"12\"");
    canvas.Text(0, y, fmt::format("{:.3g} m", y), "text-anchor=\"end\" dx=\"-4\"");
  }
  canvas.Line(robots, "stroke=\"#1f77b4\" stroke-width=\"1.5\"");
  canvas.Line(obstacles, "stroke=\"#2ca02c\" stroke-width=\"1.5\"");
  canvas.Raw(Canvas::kMargin, 18, Title(history));
  canvas.Raw(Canvas::kMargin, 32, "least distance of two robots", "fill=\"#1f77b4\"");
  canvas.Raw(Canvas::kMargin + 180, 32, "of a robot and an obstacle", "fill=\"#2ca02c\"");
  return canvas.Take();
}

}  // namespace rondo::sim
