#pragma once

#include <string_view>

#include "expr/rational.h"

/// Units and dimensions of quantities in models.
namespace rondo::lang {

/// Says what is measured, by the exponents of length, time and angle. Angles are a dimension of their own.
struct Dimension {
  int length = 0;
  int time = 0;
  int angle = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// Is a unit and its size in SI units (REP-103: metre, second, radian): numerator / denominator. `deg` has no
/// rational size: it is pi / 180, and its size is 1 / 180 with `half_turns` set.
struct Unit {
  std::string_view name;
  Dimension dimension;
  int64_t numerator;
  int64_t denominator;
  bool half_turns = false;  ///< whether the size is multiplied by pi
};

/// Returns the unit of this name (`m`, `cm`, `mm`, `s`, `ms`, `rad`, `deg`); nullptr if there is none.
const Unit* FindUnit(std::string_view name);

/// Returns the dimension `length`, `time`, `angle`, `speed`, `acceleration`, `angular_speed` or `number`;
/// nullptr for other names.
const Dimension* FindDimension(std::string_view name);

}  // namespace rondo::lang
