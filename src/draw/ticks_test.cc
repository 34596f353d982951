#include "draw/ticks.h"

#include <gmock/gmock.h>

#include <limits>

namespace rondo::draw {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(TicksTest, AreRoundNumbers) {
  EXPECT_THAT(Ticks(0, 10, 6), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(Ticks(0, 10, 3), ElementsAre(0, 5, 10));
  EXPECT_THAT(Ticks(0, 0.47, 5), ElementsAre(0, DoubleEq(0.1), DoubleEq(0.2), DoubleEq(0.3), DoubleEq(0.4)));
  EXPECT_THAT(Ticks(-3, 3, 4), ElementsAre(-2, 0, 2));
}

TEST(TicksTest, AreNeverMoreThanAllowed) {
  for (size_t most = 1; most < 20; ++most) {
    for (const double hi : {0.001, 0.7, 1.0, 9.99, 123.0, 8e9}) {
      EXPECT_LE(Ticks(0, hi, most).size(), most) << hi;
      EXPECT_GE(Ticks(0, hi, most).size(), 1U) << hi;
    }
  }
}

TEST(TicksTest, AnAxisThatIsEmptyHasNone) {
  EXPECT_THAT(Ticks(1, 1, 5), IsEmpty());
  EXPECT_THAT(Ticks(0, std::numeric_limits<double>::infinity(), 5), IsEmpty());
  EXPECT_THAT(Ticks(0, std::numeric_limits<double>::quiet_NaN(), 5), IsEmpty());
  EXPECT_THAT(Ticks(0, 1, 0), IsEmpty());
}

}  // namespace
}  // namespace rondo::draw
