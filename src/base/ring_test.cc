#include "base/ring.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "base/hex.h"

namespace rondo::base {
namespace {

using namespace std::chrono_literals;

TEST(Ring, ItemsComeInOrderAndTheOldestGiveWay) {
  Ring<std::string> ring(2);
  for (const char* text : {"a", "b", "c"}) ring.Put([&](std::string& item) { item = text; });
  EXPECT_EQ(ring.lost(), 1U);
  std::string item = "old";
  ASSERT_TRUE(ring.Take(0s, item));
  EXPECT_EQ(item, "b");
  ASSERT_TRUE(ring.Take(0s, item));
  EXPECT_EQ(item, "c");
  EXPECT_FALSE(ring.Take(1ms, item));
  EXPECT_EQ(item, "c");
}

TEST(Ring, KeepsTheMemoryOfItems) {
  Ring<std::string> ring(1);
  std::string item(1000, 'x');
  ring.Put([](std::string& i) { i = "first"; });
  ASSERT_TRUE(ring.Take(0s, item));
  size_t capacity = 0;
  ring.Put([&](std::string& i) { capacity = i.capacity(); });
  EXPECT_GE(capacity, 1000U);
}

TEST(Ring, WhatWaitsWhenItIsClosedCanBeTaken) {
  Ring<int> ring(4);
  ring.Put([](int& i) { i = 7; });
  ring.Close();
  int item = 0;
  EXPECT_TRUE(ring.Take(10s, item));
  EXPECT_EQ(item, 7);
  EXPECT_FALSE(ring.Take(10s, item));
  EXPECT_TRUE(ring.closed());
}

TEST(Ring, NothingIsLostBetweenThreadsThatKeepUp) {
  Ring<int> ring(1 << 20);
  std::thread other([&] {
    for (int i = 1; i <= 10'000; ++i) ring.Put([&](int& item) { item = i; });
  });
  int item = 0;
  for (int i = 1; i <= 10'000; ++i) {
    ASSERT_TRUE(ring.Take(10s, item));
    EXPECT_EQ(item, i);
  }
  other.join();
}

TEST(Hex, ThereAndBack) {
  const std::vector<uint8_t> bytes{0, 1, 0xab, 0xff};
  EXPECT_EQ(Hex(bytes), "0001abff");
  EXPECT_EQ(FromHex("0001abff"), bytes);
  for (const char* bad : {"0", "0g", "AB", "0x00"}) EXPECT_FALSE(FromHex(bad)) << bad;
}

}  // namespace
}  // namespace rondo::base
