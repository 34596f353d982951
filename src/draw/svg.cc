#include "draw/svg.h"

#include <fmt/format.h>

#include <cmath>

#include "base/xml.h"

namespace rondo::draw {
namespace {

constexpr double kCharacter = 6.6;  // of 11 px in the font below, on average
constexpr double kHead = 7;

std::string_view Name(Svg::Anchor anchor) {
  switch (anchor) {
    case Svg::Anchor::kStart:
      return "start";
    case Svg::Anchor::kMiddle:
      return "middle";
    case Svg::Anchor::kEnd:
      return "end";
  }
  return "";
}

// What differs from the way in which everything is painted unless it says otherwise.
std::string Paint(const Svg::Style& style) {
  std::string paint = fmt::format(R"( fill="{}" stroke="{}")", style.fill, style.stroke);
  if (style.width != 1) paint += fmt::format(R"( stroke-width="{:g}")", style.width);
  if (style.opacity != 1) paint += fmt::format(R"( fill-opacity="{:g}")", style.opacity);
  if (style.radius > 0) paint += fmt::format(R"( rx="{:.1f}")", style.radius);
  if (style.dashed) paint += R"( stroke-dasharray="4 3")";
  return paint;
}

}  // namespace

double Svg::WidthOf(std::string_view text) { return kCharacter * static_cast<double>(text.size()); }

void Svg::Rect(double x, double y, double width, double height, const Style& style) {
  body_ += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"{}/>)", x, y, width,
                       height, Paint(style));
  body_ += '\n';
}

void Svg::Circle(double x, double y, double radius, const Style& style) {
  body_ += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}"{}/>)", x, y, radius, Paint(style));
  body_ += '\n';
}

void Svg::Polygon(const std::vector<std::array<double, 2>>& points, const Style& style) {
  body_ += "<polygon points=\"";
  for (const auto& [x, y] : points) body_ += fmt::format("{:.1f},{:.1f} ", x, y);
  body_ += fmt::format("\" fill=\"{}\" fill-opacity=\"0.35\" stroke=\"{}\"/>\n", style.fill, style.stroke);
}

void Svg::Line(double x1, double y1, double x2, double y2, std::string_view stroke, bool dashed) {
  body_ += fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"{}/>)", x1, y1, x2,
                       y2, stroke, dashed ? R"( stroke-dasharray="4 3")" : "");
  body_ += '\n';
}

void Svg::Polyline(const std::vector<std::array<double, 2>>& points, std::string_view stroke, double width,
                   double opacity) {
  if (points.empty()) return;
  body_ += "<polyline points=\"";
  const std::array<double, 2>* last = nullptr;
  for (const auto& point : points) {
    // Nobody sees less than a pixel.
    if (last != nullptr && &point != &points.back() &&
        std::hypot(point[0] - (*last)[0], point[1] - (*last)[1]) < 1)
      continue;
    body_ += fmt::format("{:.1f},{:.1f} ", point[0], point[1]);
    last = &point;
  }
  body_ += fmt::format("\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" stroke-opacity=\"{:g}\"/>\n",
                       stroke, width, opacity);
}

void Svg::Arrow(double x1, double y1, double x2, double y2, std::string_view stroke) {
  Line(x1, y1, x2, y2, stroke);
  const double length = std::hypot(x2 - x1, y2 - y1);
  if (length == 0) return;
  const double ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  const double bx = x2 - kHead * ux, by = y2 - kHead * uy;
  body_ +=
      fmt::format("<path d=\"M{:.1f} {:.1f} L{:.1f} {:.1f} L{:.1f} {:.1f} Z\" fill=\"{}\"/>\n", x2, y2,
                  bx - kHead / 2 * uy, by + kHead / 2 * ux, bx + kHead / 2 * uy, by - kHead / 2 * ux, stroke);
}

void Svg::Bow(double x1, double y1, double x2, double y2, double out, std::string_view stroke) {
  body_ += fmt::format(
      "<path d=\"M{:.1f} {:.1f} C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}\" fill=\"none\" stroke=\"{}\"/>\n",
      x1, y1, out, y1, out, y2, x2 + kHead, y2, stroke);
  Arrow(x2 + kHead + 1, y2, x2, y2, stroke);
}

void Svg::Text(double x, double y, std::string_view text, Anchor anchor, double width, bool bold,
               std::string_view colour) {
  std::string shown(text);
  const auto fits = static_cast<size_t>(width / kCharacter);
  if (shown.size() > fits && fits > 1) {
    size_t cut = fits - 1;
    while (cut > 0 && (static_cast<unsigned char>(shown[cut]) & 0xC0u) == 0x80u) --cut;
    shown = shown.substr(0, cut) + "\u2026";
  }
  body_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}")", x, y, Name(anchor));
  if (bold) body_ += R"( font-weight="bold")";
  if (colour != "black") body_ += fmt::format(R"( fill="{}")", colour);
  body_ += '>';
  if (shown != text) body_ += "<title>" + base::XmlEscaped(text) + "</title>";
  body_ += base::XmlEscaped(shown) + "</text>\n";
}

std::string Svg::Finish(double width, double height, std::string_view title) const {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
             "font-family=\"sans-serif\" font-size=\"11\">\n"
             "<title>{2}</title>\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             width, height, base::XmlEscaped(title)) +
         body_ + "</svg>\n";
}

}  // namespace rondo::draw
