#pragma once

#include <string_view>

#include "expr/rational.h"

namespace rondo::lang {

/// Exponents of what is measured. Angles are a dimension of their own.
struct Dimension {
  int length = 0;
  int time = 0;
  int angle = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// A unit and its size in SI units (REP-103: metre, second, radian). `deg` has no rational size: it is
/// pi / 180, and `size` is 1 / 180 with `half_turns` set.
struct Unit {
  std::string_view name;
  Dimension dimension;
  int64_t numerator;
  int64_t denominator;
  bool half_turns = false;  ///< times pi
};

/// nullptr if there is no unit of this name.
const Unit* FindUnit(std::string_view name);

/// `length`, `time`, `angle`, `speed`, `acceleration`, `angular_speed`, `number`; nullptr for other names.
const Dimension* FindDimension(std::string_view name);

}  // namespace rondo::lang
