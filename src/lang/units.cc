#include "lang/units.h"

#include <array>
#include <utility>

namespace rondo::lang {
namespace {

constexpr Dimension kLength{1, 0, 0};
constexpr Dimension kTime{0, 1, 0};
constexpr Dimension kAngle{0, 0, 1};

constexpr std::array<Unit, 7> kUnits{{{"m", kLength, 1, 1},
                                      {"cm", kLength, 1, 100},
                                      {"mm", kLength, 1, 1000},
                                      {"s", kTime, 1, 1},
                                      {"ms", kTime, 1, 1000},
                                      {"rad", kAngle, 1, 1},
                                      {"deg", kAngle, 1, 180, true}}};

constexpr std::array<std::pair<std::string_view, Dimension>, 7> kDimensions{{{"number", {}},
                                                                             {"length", kLength},
                                                                             {"time", kTime},
                                                                             {"angle", kAngle},
                                                                             {"speed", {1, -1, 0}},
                                                                             {"acceleration", {1, -2, 0}},
                                                                             {"angular_speed", {0, -1, 1}}}};

}  // namespace

const Unit* FindUnit(std::string_view name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

const Dimension* FindDimension(std::string_view name) {
  for (const auto& [known, dimension] : kDimensions) {
    if (known == name) return &dimension;
  }
  return nullptr;
}

}  // namespace rondo::lang
