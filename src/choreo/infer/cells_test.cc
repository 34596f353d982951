#include "choreo/infer/cells.h"

#include <gtest/gtest.h>

namespace rondo::choreo {
namespace {

// A box in the plane of x and y, of height one.
Extent Box(size_t thread, double x0, double x1, double y0, double y1) {
  Extent e;
  e.thread = thread;
  Extent::Moment m{};
  for (size_t d = 0; d < kDirections.size(); ++d) {
    const auto [a, b, c] = kDirections[d];
    m.least[d] = m.most[d] = 0;
    const auto add = [&](int factor, double low, double high) {
      m.least[d] += factor < 0 ? factor * high : factor * low;
      m.most[d] += factor < 0 ? factor * low : factor * high;
    };
    add(a, x0, x1);
    add(b, y0, y1);
    add(c, 0, 1);
  }
  e.moments = {m};
  return e;
}

TEST(Cells, OnePlaneBetweenTwo) {
  const Cells cells = Separate({Box(0, 0, 1, 0, 1), Box(1, 2, 3, 0, 1)}, 2);
  ASSERT_FALSE(cells.conflict);
  EXPECT_EQ(ToText(cells.by_thread[0]), "x < 1.5 m");
  EXPECT_EQ(ToText(cells.by_thread[1]), "x > 1.5 m");
}

TEST(Cells, AnExtentMayBeOnBothSides) {
  // An angle around a block.
  const Cells cells = Separate({Box(0, 0, 1, 0, 3), Box(0, 0, 3, 0, 1), Box(1, 1.5, 3, 1.5, 3)}, 2);
  ASSERT_FALSE(cells.conflict);
  EXPECT_GE(cells.by_thread[0].size(), 1u);
  EXPECT_EQ(cells.by_thread[1].size(), 1u);
}

TEST(Cells, WhatOverlapsIsNamed) {
  const Cells cells = Separate({Box(0, 0, 1, 0, 1), Box(1, 0.5, 2, 0, 1)}, 2);
  ASSERT_TRUE(cells.conflict);
  EXPECT_NE(cells.conflict->first.thread, cells.conflict->second.thread);
}

TEST(Cells, StatesAreDividedWhereBoxesAreNot) {
  // One goes along the diagonal, the other one stands beside it: their boxes overlap, no moment does.
  Extent along = Box(0, 0, 0.1, 0, 0.1);
  for (int k = 1; k <= 20; ++k)
    along.moments.push_back(Box(0, 0.1 * k, 0.1 * k + 0.1, 0.1 * k, 0.1 * k + 0.1).moments[0]);
  const Cells cells = Separate({along, Box(1, 1.4, 1.5, 0, 0.1)}, 2);
  EXPECT_FALSE(cells.conflict);
}

TEST(Cells, TextIsShort) {
  EXPECT_EQ(ToText({}), "false");
  EXPECT_EQ(ToText({{}}), "true");
  EXPECT_EQ(ToText({{{0, 1, true}, {0, 0.5, true}, {2, 0.25, false}}}), "x < 0.5 m and z > 0.25 m");
  EXPECT_EQ(Offset(-0.00001), "0");
}

}  // namespace
}  // namespace rondo::choreo
