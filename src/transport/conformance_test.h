#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "transport/transport.h"

/// What every transport has to keep, whatever it is made of. A transport instantiates the suite with a class that has
/// `std::vector<std::unique_ptr<Transport>> Connect(size_t robots)`; nothing is lost between these transports.
namespace rondo::transport {

using runtime::codec::Bytes;
using runtime::rounds::kAll;
using runtime::rounds::Time;

template <class Fleet>
class TransportConformance : public testing::Test {
 protected:
  static constexpr Time kSoon = 2'000'000'000;  // long enough for what is under way
  static std::optional<Bytes> Next(Transport& way, Time wait = kSoon) {
    Bytes datagram{3, 1, 4};  // what was there before is gone
    const bool came = way.Receive(way.Now() + wait, datagram);
    EXPECT_EQ(came, !datagram.empty());
    return came ? std::optional(datagram) : std::nullopt;
  }
  // Nothing is under way any more.
  static bool Silent(Transport& way) { return !Next(way, 20'000'000); }
  Fleet fleet_;
};
TYPED_TEST_SUITE_P(TransportConformance);

TYPED_TEST_P(TransportConformance, ADatagramComesToTheRobotThatItIsForAndToNobodyElse) {
  auto ways = this->fleet_.Connect(3);
  ways[0]->Send(1, Bytes{1});
  EXPECT_EQ(this->Next(*ways[1]), Bytes{1});
  for (const auto& way : ways) EXPECT_TRUE(this->Silent(*way));
}

TYPED_TEST_P(TransportConformance, WhatIsForAllComesToAllOthers) {
  auto ways = this->fleet_.Connect(4);
  ways[2]->Send(kAll, Bytes{7});
  for (const size_t r : {0U, 1U, 3U}) EXPECT_EQ(this->Next(*ways[r]), Bytes{7}) << r;
  for (const auto& way : ways) EXPECT_TRUE(this->Silent(*way));
}

TYPED_TEST_P(TransportConformance, ADatagramIsWhole) {
  auto ways = this->fleet_.Connect(2);
  for (const size_t size : {1U, 2U, 255U, 256U, 1000U, 1200U}) {
    Bytes bytes(size);
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * 7 + size);
    ways[1]->Send(0, bytes);
    EXPECT_EQ(this->Next(*ways[0]), bytes) << size;
  }
}

TYPED_TEST_P(TransportConformance, WaitingEndsWhenItIsTime) {
  auto ways = this->fleet_.Connect(2);
  const Time until = ways[0]->Now() + 3'000'000;
  Bytes datagram;
  EXPECT_FALSE(ways[0]->Receive(until, datagram));
  EXPECT_GE(ways[0]->Now(), until);
  EXPECT_FALSE(ways[0]->Receive(ways[0]->Now() - 1'000'000, datagram));  // that was before
}

TYPED_TEST_P(TransportConformance, ClocksNeverStepBack) {
  auto ways = this->fleet_.Connect(2);
  Time last = ways[0]->Now();
  for (int i = 0; i < 1000; ++i) {
    if (i % 100 == 0) this->Next(*ways[0], 100'000);
    const Time now = ways[0]->Now();
    EXPECT_GE(now, last);
    last = now;
  }
}

TYPED_TEST_P(TransportConformance, NobodyWaitsForThoseWhoDoNotListen) {
  auto ways = this->fleet_.Connect(2);
  constexpr int kMany = 5000;
  for (int i = 0; i < kMany; ++i)
    ways[0]->Send(1, Bytes{static_cast<uint8_t>(i), static_cast<uint8_t>(i >> 8), 9});
  // What comes was sent, and each datagram once.
  std::set<Bytes> seen;
  while (const auto bytes = this->Next(*ways[1], 20'000'000)) {
    ASSERT_EQ(bytes->size(), 3U);
    EXPECT_EQ((*bytes)[2], 9);
    EXPECT_LT((*bytes)[0] + ((*bytes)[1] << 8), kMany);
    EXPECT_TRUE(seen.insert(*bytes).second);
  }
  EXPECT_FALSE(seen.empty());
  ways[0]->Send(1, Bytes{42});
  EXPECT_EQ(this->Next(*ways[1]), Bytes{42});
}

REGISTER_TYPED_TEST_SUITE_P(TransportConformance, ADatagramComesToTheRobotThatItIsForAndToNobodyElse,
                            WhatIsForAllComesToAllOthers, ADatagramIsWhole, WaitingEndsWhenItIsTime,
                            ClocksNeverStepBack, NobodyWaitsForThoseWhoDoNotListen);

}  // namespace rondo::transport
