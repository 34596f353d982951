#include "transport/simulated/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "transport/simulated/clock.h"

namespace rondo::transport::simulated {
namespace {

const std::vector<uint8_t> kBytes{1, 2, 3, 4};

TEST(Network, LosesAndDoublesTheShareThatIsAsked) {
  Network network(2, 1);
  network.conditions.loss = 0.3;
  network.conditions.duplicate = 0.5;
  std::vector<Delivery> out;
  for (int i = 0; i < 10'000; ++i) network.Send(0, 0, 1, kBytes, out);
  EXPECT_NEAR(static_cast<double>(out.size()), 10'000 * 0.7 * 1.5, 300);
  EXPECT_EQ(network.sent(), 10'000U);
  EXPECT_EQ(network.bytes(), 40'000U);
}

TEST(Network, TakesTheTimeThatIsAskedAndReorders) {
  Network network(2, 1);
  network.conditions.least = 10;
  network.conditions.most = 20;
  std::vector<Delivery> out;
  for (int i = 0; i < 1000; ++i) network.Send(100, 0, 1, kBytes, out);
  const auto [first, last] = std::ranges::minmax(out, {}, &Delivery::at);
  EXPECT_EQ(first.at, 110);
  EXPECT_EQ(last.at, 120);
  EXPECT_FALSE(std::ranges::is_sorted(out, {}, &Delivery::at));
}

TEST(Network, DamageIsOneBit) {
  Network network(2, 1);
  network.conditions.corrupt = 1;
  std::vector<Delivery> out;
  for (int i = 0; i < 100; ++i) network.Send(0, 0, 1, kBytes, out);
  for (const Delivery& d : out) {
    int bits = 0;
    for (size_t i = 0; i < kBytes.size(); ++i)
      bits += std::popcount(static_cast<unsigned>(d.bytes[i] ^ kBytes[i]));
    EXPECT_EQ(bits, 1);
  }
}

TEST(Network, CutsAddUpAndHaveADirection) {
  Network network(3, 1);
  network.Cut(0, 1);
  network.Cut(0, 1);
  network.Mend(0, 1);
  std::vector<Delivery> out;
  network.Send(0, 0, 1, kBytes, out);
  EXPECT_TRUE(out.empty());
  network.Send(0, 1, 0, kBytes, out);
  network.Send(0, 0, 2, kBytes, out);
  EXPECT_EQ(out.size(), 2U);
  network.Mend(0, 1);
  network.Mend(0, 1);  // one too many
  network.Send(0, 0, 1, kBytes, out);
  EXPECT_EQ(out.size(), 3U);
}

TEST(Clock, WhenIsTheFirstMomentAtWhichItSaysSo) {
  for (const Clock clock : {Clock{}, Clock{12345, 100}, Clock{-7, -100}, Clock{1'000'000'000'000, 99}}) {
    for (const int64_t time : {int64_t{0}, int64_t{1}, int64_t{999'999}, int64_t{123'456'789'012}}) {
      const int64_t local = clock.At(time);
      const int64_t when = clock.When(local);
      EXPECT_GE(clock.At(when), local);
      EXPECT_TRUE(when == 0 || clock.At(when - 1) < local) << time;
    }
  }
}

}  // namespace
}  // namespace rondo::transport::simulated
