#include "lsp/positions.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace rondo::lsp {
namespace {

TEST(Positions, CountWhatTheEncodingSays) {
  const std::string text = "a\xc3\xa4\xf0\x9f\xa4\x96z\nb\r\n";  // a, a with dots, a robot, z
  EXPECT_EQ(OffsetOf(text, {0, 4}, Encoding::kUtf16), 7U);
  EXPECT_EQ(OffsetOf(text, {0, 7}, Encoding::kUtf8), 7U);
  EXPECT_EQ(PositionOf(text, 7, Encoding::kUtf16), (Position{0, 4}));
  EXPECT_EQ(PositionOf(text, 7, Encoding::kUtf8), (Position{0, 7}));
  EXPECT_EQ(OffsetOf(text, {0, 3}, Encoding::kUtf16), 3U);  // in the middle of the robot
  EXPECT_EQ(OffsetOf(text, {1, 99}, Encoding::kUtf16), 10U);
  EXPECT_EQ(OffsetOf(text, {9, 0}, Encoding::kUtf16), text.size());
  EXPECT_EQ(PositionOf(text, 999, Encoding::kUtf16), (Position{2, 0}));
  EXPECT_EQ(PositionOf("", 0, Encoding::kUtf16), Position());
}

// There and back, in any text: also in one that is no UTF-8.
TEST(Positions, GoThereAndBack) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (uint64_t k = random() % 30; k > 0; --k)
      text += random() % 4 == 0 ? '\n' : static_cast<char>(random() % 256);
    for (const Encoding encoding : {Encoding::kUtf16, Encoding::kUtf8}) {
      for (size_t offset = 0; offset <= text.size(); ++offset) {
        if (offset > 0 && text.substr(offset - 1, 2) == "\r\n") continue;  // inside of what ends a line
        const Position position = PositionOf(text, offset, encoding);
        EXPECT_LE(OffsetOf(text, position, encoding), offset);
        EXPECT_EQ(PositionOf(text, OffsetOf(text, position, encoding), encoding), position);
      }
    }
  }
}

}  // namespace
}  // namespace rondo::lsp
