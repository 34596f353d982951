#include "lang/units.h"

#include <gtest/gtest.h>

namespace rondo::lang {
namespace {

TEST(Units, LengthsAreMeasuredInMetres) {
  for (const auto& [name, parts] : {std::pair<const char*, int64_t>{"m", 1}, {"cm", 100}, {"mm", 1000}}) {
    const Unit* unit = FindUnit(name);
    ASSERT_NE(unit, nullptr) << name;
    EXPECT_EQ(unit->dimension, (Dimension{1, 0, 0}));
    EXPECT_EQ(unit->denominator, parts * unit->numerator);
    EXPECT_FALSE(unit->half_turns);
  }
}

TEST(Units, AMillisecondIsAThousandthOfASecond) {
  const Unit* s = FindUnit("s");
  const Unit* ms = FindUnit("ms");
  ASSERT_TRUE(s != nullptr && ms != nullptr);
  EXPECT_EQ(s->dimension, ms->dimension);
  EXPECT_EQ(s->dimension, (Dimension{0, 1, 0}));
  EXPECT_EQ(ms->denominator * s->numerator, 1000 * ms->numerator * s->denominator);
}

TEST(Units, ADegreeIsAHundredAndEightiethOfAHalfTurn) {
  const Unit* deg = FindUnit("deg");
  const Unit* rad = FindUnit("rad");
  ASSERT_TRUE(deg != nullptr && rad != nullptr);
  EXPECT_EQ(deg->dimension, rad->dimension);
  EXPECT_TRUE(deg->half_turns);
  EXPECT_FALSE(rad->half_turns);
  EXPECT_EQ(deg->denominator, 180 * deg->numerator);
}

TEST(Units, OtherNamesAreNoUnits) {
  for (const char* name : {"", "M", "km", "metre", "m ", "speed"}) EXPECT_EQ(FindUnit(name), nullptr) << name;
}

TEST(Units, DimensionsAreProductsOfLengthTimeAndAngle) {
  EXPECT_EQ(*FindDimension("number"), (Dimension{0, 0, 0}));
  EXPECT_EQ(*FindDimension("speed"), (Dimension{1, -1, 0}));
  EXPECT_EQ(*FindDimension("acceleration"), (Dimension{1, -2, 0}));
  EXPECT_EQ(*FindDimension("angular_speed"), (Dimension{0, -1, 1}));
}

TEST(Units, OtherNamesAreNoDimensions) {
  for (const char* name : {"", "m", "mass", "Speed"}) EXPECT_EQ(FindDimension(name), nullptr) << name;
}

}  // namespace
}  // namespace rondo::lang
