#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rondo::draw {

/// An SVG picture that is written element by element. Lengths in pixels, y downwards; text is escaped.
class Svg {
 public:
  struct Style {
    std::string_view fill = "none";
    std::string_view stroke = "none";
    bool dashed = false;
    double radius = 0;  ///< of the corners of rectangles
  };
  enum class Anchor : uint8_t { kStart, kMiddle, kEnd };

  void Rect(double x, double y, double width, double height, const Style& style);
  /// Half transparent.
  void Polygon(const std::vector<std::array<double, 2>>& points, const Style& style);
  void Line(double x1, double y1, double x2, double y2, std::string_view stroke, bool dashed = false);
  void Polyline(const std::vector<std::array<double, 2>>& points, std::string_view stroke, double width = 1,
                double opacity = 1);
  /// A line with a head at its end.
  void Arrow(double x1, double y1, double x2, double y2, std::string_view stroke);
  /// Bends out to x = `out` between its ends, with a head at the end.
  void Bow(double x1, double y1, double x2, double y2, double out, std::string_view stroke);
  /// At most `width` pixels wide: what does not fit is cut, and shown as a whole when pointed at.
  void Text(double x, double y, std::string_view text, Anchor anchor, double width, bool bold = false);

  /// The whole picture, on white.
  std::string Finish(double width, double height, std::string_view title) const;

  /// How wide a text is, nearly.
  static double WidthOf(std::string_view text);

 private:
  std::string body_;
};

}  // namespace rondo::draw
