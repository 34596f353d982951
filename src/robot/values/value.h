#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lang/units.h"
#include "robot/values/shape.h"

namespace rondo::robot {

enum class ValueKind : uint8_t {
  kError,        ///< reported already; agrees with everything
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

/// What an expression about robots means: terms, with what they measure.
struct Value {
  ValueKind kind = ValueKind::kError;
  lang::Dimension dimension;
  /// Fits to every dimension: 0, infinity, and numbers of files that know no units.
  bool any_dimension = false;
  std::vector<TermId> terms;
  /// The value is the square root of this: distances are compared without the root.
  std::optional<TermId> squared;
  std::shared_ptr<const Pose> pose;
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Members> members;
};

Value Quantity(TermId term, lang::Dimension dimension);
Value Boolean(TermId term);
Value PointAt(const Vector& p);
Value FrameAt(const Pose& pose);
Value ShapeOf(Shape shape);

/// The variables that terms depend on.
std::set<TermId> VariablesOf(const Arena& arena, const std::vector<TermId>& terms);

/// Does it depend on no variable?
bool IsConstant(const Arena& arena, const Value& value);
bool IsConstant(const Arena& arena, const Pose& pose);
bool IsConstant(const Arena& arena, const Shape& shape);

/// "a length", "a point", "coordinates in m"; for messages.
std::string Describe(const Value& value);
/// "m", "m/s", "rad", "a number"
std::string UnitText(lang::Dimension dimension);

inline constexpr lang::Dimension kLength{1, 0, 0};
inline constexpr lang::Dimension kTime{0, 1, 0};
inline constexpr lang::Dimension kAngle{0, 0, 1};

}  // namespace rondo::robot
