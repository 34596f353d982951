#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lang/units.h"
#include "robot/values/shape.h"

/// Represents the values of expressions about robots.
namespace rondo::robot {

/// Names the kinds of values and which fields they use.
enum class ValueKind : uint8_t {
  kError,        ///< it was reported already, and agrees with everything
  kBool,         ///< terms: one
  kQuantity,     ///< terms: one, in SI units
  kCoordinates,  ///< terms: two or three; of no frame in particular
  kPoint,        ///< terms: three; coordinates in the world, metres
  kFrame,        ///< pose
  kShape,        ///< shape
  kComponent,    ///< members: a robot or a part of the environment
};

struct Value;
using Members = std::map<std::string, Value, std::less<>>;

/// Holds what an expression about robots means: terms, with what they measure.
struct Value {
  ValueKind kind = ValueKind::kError;
  lang::Dimension dimension;
  /// Says that the value fits to every dimension: 0, infinity, and numbers of files that know no units.
  bool any_dimension = false;
  std::vector<TermId> terms;
  /// Holds, if the value is a square root, what it is the root of: distances are compared without the root.
  std::optional<TermId> squared;
  std::shared_ptr<const Pose> pose;
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Members> members;
};

/// Return the value of each kind for its terms; a quantity is in SI units, a point in world coordinates
/// (metres).
Value Quantity(TermId term, lang::Dimension dimension);
Value Boolean(TermId term);
Value PointAt(const Vector& p);
Value FrameAt(const Pose& pose);
Value ShapeOf(Shape shape);

/// Returns the variables that terms depend on.
std::set<TermId> VariablesOf(const Arena& arena, const std::vector<TermId>& terms);

/// Reports whether it depends on no variable.
bool IsConstant(const Arena& arena, const Value& value);
bool IsConstant(const Arena& arena, const Pose& pose);
bool IsConstant(const Arena& arena, const Shape& shape);

/// Returns what a value is, in words for messages: "a length", "a point", "coordinates in m".
std::string Describe(const Value& value);
/// Returns the SI unit of a dimension as text: "m", "m/s", "rad", "a number".
std::string UnitText(lang::Dimension dimension);

/// Name the dimensions of quantities: powers of length, time and angle.
inline constexpr lang::Dimension kLength{1, 0, 0};
inline constexpr lang::Dimension kTime{0, 1, 0};
inline constexpr lang::Dimension kAngle{0, 0, 1};

}  // namespace rondo::robot
