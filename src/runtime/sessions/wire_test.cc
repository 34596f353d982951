#include "runtime/sessions/wire.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace rondo::runtime::sessions {
namespace {

using codec::Bytes;
using codec::Refused;

constexpr uint64_t kAgreement = 0x1234, kSession = 77;
constexpr size_t kRobots = 70;

Datagram Random(std::mt19937_64& random) {
  Datagram d{kAgreement, {static_cast<uint32_t>(random() % kRobots), random() % 1000}, {}};
  if (random() % 2 == 0) {
    Alive alive;
    alive.phase = static_cast<Phase>(random() % 5);
    for (size_t r = 0; r < kRobots; ++r) {
      if (random() % 2 == 0) alive.heard.Add(r);
    }
    if (alive.phase >= Phase::kEnded) {
      for (size_t r = 0; r < kRobots; ++r) {
        alive.sent.push_back(random() % 300);
        alive.taken.push_back(random() % 3);
      }
    }
    d.body = alive;
    return d;
  }
  Frame frame;
  frame.kind = static_cast<Frame::Kind>(random() % 2);
  frame.session = kSession;
  frame.from = d.sender.robot;
  frame.to = (frame.from + 1 + static_cast<uint32_t>(random() % (kRobots - 1))) % kRobots;
  frame.number = random() % 1000;
  if (frame.kind == Frame::Kind::kOffer) {
    frame.label = std::string(random() % kMostLabel, 'a');
    for (size_t i = random() % 5; i > 0; --i) frame.values.push_back(static_cast<double>(random()) / 7);
  }
  d.body = frame;
  return d;
}

Bytes BytesOf(const Datagram& d) {
  Bytes bytes;
  Encode(d, kSession, bytes);
  return bytes;
}

TEST(Wire, ReadsWhatItWrote) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Datagram d = Random(random);
    const Bytes bytes = BytesOf(d);
    Datagram back;
    ASSERT_EQ(Decode(bytes, kAgreement, kSession, kRobots, back), Refused::kNothing);
    EXPECT_EQ(back.sender, d.sender);
    EXPECT_EQ(BytesOf(back), bytes);
    const auto* alive = std::get_if<Alive>(&d.body);
    EXPECT_TRUE(alive == nullptr || std::get<Alive>(back.body) == *alive);
  }
}

TEST(Wire, TellsWhyItRefuses) {
  Datagram back;
  const Bytes bytes = BytesOf({kAgreement, {1, 2}, Alive()});
  EXPECT_EQ(Decode(bytes, kAgreement + 1, kSession, kRobots, back), Refused::kForeign);
  EXPECT_EQ(Decode(bytes, kAgreement, kSession + 1, kRobots, back), Refused::kSession);
  EXPECT_EQ(Decode(bytes, kAgreement, kSession, 1, back), Refused::kMalformed);
  EXPECT_EQ(Decode({}, kAgreement, kSession, kRobots, back), Refused::kDamaged);
  Frame own;
  own.from = own.to = 1;
  EXPECT_EQ(Decode(BytesOf({kAgreement, {1, 2}, own}), kAgreement, kSession, kRobots, back),
            Refused::kMalformed);
  Frame none;
  none.from = 1;
  none.values = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(Decode(BytesOf({kAgreement, {1, 2}, none}), kAgreement, kSession, kRobots, back),
            Refused::kMalformed);
}

// What is damaged behind the sum is refused, or is the one way to write something else.
TEST(Wire, NoBytesHurtIt) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes = BytesOf(Random(random));
    const bool cut = random() % 4 == 0;
    if (cut) bytes.resize(random() % bytes.size());
    for (uint64_t k = random() % 4; k > 0 && !bytes.empty(); --k)
      bytes[random() % bytes.size()] ^= 1U << random() % 8;
    Datagram back;
    if (random() % 2 == 0 && bytes.size() > 8) {  // as somebody who knows how sums are made
      Bytes sum;
      codec::Writer(sum).Fixed(codec::Sum(codec::View(bytes).subspan(8)));
      std::ranges::copy(sum, bytes.begin());
    }
    const Refused refused = Decode(bytes, kAgreement, kSession, kRobots, back);
    EXPECT_TRUE(refused != Refused::kNothing || BytesOf(back) == bytes);
  }
}

}  // namespace
}  // namespace rondo::runtime::sessions
