#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Pictures for people: tubes, choreographies, plots. Nothing is concluded from a picture.
namespace rondo::draw {

/// Writes an SVG picture element by element. Lengths and places in pixels, x to the right, y downwards; later
/// elements cover earlier ones. Texts are escaped; colours are written as they are given, in the words of
/// SVG.
class Svg {
 public:
  /// Says how an area is painted and outlined.
  struct Style {
    std::string_view fill = "none";
    std::string_view stroke = "none";
    bool dashed = false;  ///< of outlines of rectangles
    double radius = 0;    ///< of the corners of rectangles, in pixels
    double width = 1;     ///< of the outlines of rectangles and circles, in pixels
    double opacity = 1;   ///< of what rectangles and circles are filled with
  };
  /// Says which part of a text stands at its place.
  enum class Anchor : uint8_t { kStart, kMiddle, kEnd };

  void Rect(double x, double y, double width, double height, const Style& style);
  void Circle(double x, double y, double radius, const Style& style);
  /// Draws a closed area, filled at 35 % opacity so that what is below shows through.
  void Polygon(const std::vector<std::array<double, 2>>& points, const Style& style);
  void Line(double x1, double y1, double x2, double y2, std::string_view stroke, bool dashed = false);
  /// Draws a line through the points. Points less than a pixel from the one before are left out, the last one
  /// never.
  void Polyline(const std::vector<std::array<double, 2>>& points, std::string_view stroke, double width = 1,
                double opacity = 1);
  /// Draws a straight line with a head at its end.
  void Arrow(double x1, double y1, double x2, double y2, std::string_view stroke);
  /// Draws a curve that is pulled out towards x = `out` between its ends and reaches three quarters of the
  /// way (a cubic Bezier curve with its control points there), with a head at its end.
  void Bow(double x1, double y1, double x2, double y2, double out, std::string_view stroke);
  /// Writes a text at most `width` pixels wide: what does not fit is cut, and shown as a whole when pointed
  /// at.
  void Text(double x, double y, std::string_view text, Anchor anchor, double width, bool bold = false,
            std::string_view colour = "black");

  /// Returns the whole picture, `width` x `height` pixels, on white.
  std::string Finish(double width, double height, std::string_view title) const;

  /// Estimates how wide a text is, in pixels: by its bytes and the average width of a character.
  static double WidthOf(std::string_view text);

 private:
  std::string body_;
};

}  // namespace rondo::draw
