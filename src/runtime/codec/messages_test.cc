#include "runtime/codec/messages.h"

#include <gtest/gtest.h>

#include <random>

namespace rondo::runtime::codec {
namespace {

constexpr uint64_t kAgreement = 11, kSession = 12;
constexpr size_t kRobots = 5;

Bytes Encoded(Body body) {
  Bytes bytes;
  Encode({kAgreement, kSession, {3, 7}, std::move(body)}, bytes);
  return bytes;
}
Refused Read(View bytes, Message& message) { return Decode(bytes, kAgreement, kSession, kRobots, message); }

std::vector<Body> All() {
  static const Bytes payload(kPart, 42);
  const Decision decision{2, {{0, 1}, {4, 9}}, {1, 30}, 0xabcdef};
  Status status{{1, 30}, true, true, true, false, true, {}, 3, 5};
  status.lacks.Add(200);
  return {status,
          Part{What::kFrame, {1, 30}, Member{2, 5}, 99, 0, 2, payload},
          Part{What::kStore, {2, 30}, std::nullopt, 99, 1, 2, View(payload).first(3)},
          Part{What::kFrames, {2, 30}, std::nullopt, 99, 0, 1, View(payload).first(7)},
          Prepare{2, {4, 1, 9}},
          Promise{2, {4, 1, 9}, Ballot{3, 0, 2}, decision, {1, 30}, 77},
          Promise{2, {4, 1, 9}, std::nullopt, std::nullopt, {1, 30}, 77},
          Accept{{4, 1, 9}, decision},
          Accepted{2, {4, 1, 9}},
          Refusal{2, {8, 0, 1}},
          Decided{decision}};
}

TEST(Messages, ComeBackAsTheyWereAndInOneFormOnly) {
  for (const Body& body : All()) {
    const Bytes bytes = Encoded(body);
    Message message;
    ASSERT_EQ(Read(bytes, message), Refused::kNothing) << body.index();
    EXPECT_EQ(message.sender, (Member{3, 7}));
    EXPECT_EQ(message.body.index(), body.index());
    Bytes again;
    Encode(message, again);
    EXPECT_EQ(again, bytes) << body.index();
  }
}

TEST(Messages, ADatagramOfOthersIsRefusedAndSaysWhy) {
  const Bytes bytes = Encoded(Prepare{2, {4, 1, 9}});
  Message message;
  EXPECT_EQ(Decode(bytes, kAgreement + 1, kSession, kRobots, message), Refused::kForeign);
  EXPECT_EQ(Decode(bytes, kAgreement, kSession + 1, kRobots, message), Refused::kSession);
  EXPECT_EQ(Decode(bytes, kAgreement, kSession, 3, message), Refused::kMalformed);  // there is no robot 3
}

TEST(Messages, AnyDamageIsSeen) {
  for (const Body& body : All()) {
    const Bytes good = Encoded(body);
    for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
      Bytes bad = good;
      bad[bit / 8] ^= static_cast<uint8_t>(1U << (bit % 8));
      Message message;
      EXPECT_EQ(Read(bad, message), Refused::kDamaged);
    }
    for (size_t length = 0; length < good.size(); ++length) {
      Message message;
      EXPECT_EQ(Read(View(good).first(length), message), Refused::kDamaged);
    }
  }
}

// What has a right sum and comes from nobody who follows the protocol.
TEST(Messages, AnythingElseIsRefusedOrHasOneForm) {
  std::mt19937_64 random(1);
  const std::vector<Body> all = All();
  for (int i = 0; i < 20'000; ++i) {
    Bytes bytes = Encoded(all[random() % all.size()]);
    for (int k = 0; k < 3; ++k) bytes[8 + random() % (bytes.size() - 8)] = static_cast<uint8_t>(random());
    if (random() % 4 == 0) bytes.resize(8 + random() % (bytes.size() - 8));
    const uint64_t sum = Sum(View(bytes).subspan(8));
    for (size_t k = 0; k < 8; ++k) bytes[k] = static_cast<uint8_t>(sum >> (8 * k));
    Message message;
    if (Read(bytes, message) != Refused::kNothing) continue;
    Bytes again;
    Encode(message, again);
    EXPECT_EQ(again, bytes);
  }
}

TEST(Messages, ADecisionThatGoesOnFromItselfIsNone) {
  for (const Decision& decision :
       {Decision{2, {{0, 1}}, {2, 0}, 0}, Decision{2, {}, {1, 0}, 0},
        Decision{2, {{1, 1}, {0, 1}}, {1, 0}, 0}, Decision{2, {{1, 1}, {1, 2}}, {1, 0}, 0},
        Decision{0, {{0, 1}}, {0, 0}, 0}}) {
    Message message;
    EXPECT_EQ(Read(Encoded(Decided{decision}), message), Refused::kMalformed);
  }
}

}  // namespace
}  // namespace rondo::runtime::codec
