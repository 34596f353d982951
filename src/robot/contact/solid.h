#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "robot/contact/contact.h"

/// Checks shapes for contact again and again, as they move.
namespace rondo::robot {

/// Returns the variables that the place and the sizes of a shape depend on.
std::vector<TermId> VariablesOf(Arena& arena, const Shape& shape);

/// Is one convex part of a shape where it stands: `sizes` as shapes of its kind have them; of prisms, the heights and then the
/// corners (x, y), counterclockwise; of half-spaces, the normal and the offset.
struct SolidPart {
  ShapeKind kind = ShapeKind::kSphere;
  std::array<double, 12>
      frame{};  ///< rotation, row by row, and origin: from the frame of the shape to the world
  std::vector<double> sizes;
};

/// Holds a shape for the Flexible Collision Library, in double precision. Its geometry is made anew only when its sizes
/// change. Not thread-safe.
class Solid {
 public:
  /// Returns the shape as a function of these variables, which must have all that it depends on; it stands nowhere yet.
  /// Nothing if FCL has no such shapes: intersections and half-spheres; or if it depends on what numbers cannot tell.
  static std::optional<Solid> Of(Arena& arena, const Shape& shape, std::vector<TermId> variables);
  ~Solid();
  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;

  /// Puts the shape where it is for these values of its variables. Returns false, and leaves it where it was, if it is nowhere:
  /// something has no value.
  bool Place(std::span<const double> values);
  /// Returns whether two shapes touch where they stand. A distance of `interesting` metres or more may be told too small,
  /// but not below `interesting`. Nothing if FCL cannot tell: how far from a half-space.
  std::optional<Contact> With(const Solid& other, double interesting) const;
  /// Returns the parts where they stand.
  std::vector<SolidPart> Standing() const;

 private:
  struct Parts;
  explicit Solid(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace rondo::robot
