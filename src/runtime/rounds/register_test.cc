#include "runtime/rounds/register.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace rondo::runtime::rounds {
namespace {

Decision Of(uint64_t digest) { return {2, {{0, 1}}, {1, 5}, digest}; }

TEST(Register, APromiseHoldsAgainstWhatIsLess) {
  Voter voter;
  EXPECT_TRUE(voter.Prepare({3, 1}));
  EXPECT_TRUE(voter.Prepare({3, 1}));
  EXPECT_FALSE(voter.Prepare({3, 0}));
  EXPECT_FALSE(voter.Accept({2, 9}, Of(1)));
  EXPECT_TRUE(voter.Accept({3, 1}, Of(1)));
  EXPECT_TRUE(voter.Accept({4, 0}, Of(2)));
  EXPECT_EQ(voter.value->digest, 2U);
  EXPECT_FALSE(voter.Prepare({3, 1}));
}

TEST(Register, AnAttemptIsBoundToWhatWasAcceptedLast) {
  Attempt attempt(2, {9, 0}, 5, 3);
  EXPECT_FALSE(attempt.Promised(0, {2, {9, 0}, Ballot{4, 1}, Of(4), {1, 3}, 13}));
  EXPECT_FALSE(attempt.Promised(0, {2, {9, 0}, Ballot{8, 1}, Of(8), {1, 9}, 19}));  // its second
  EXPECT_FALSE(attempt.Promised(1, {2, {9, 0}, Ballot{6, 1}, Of(6), {1, 4}, 14}));
  EXPECT_TRUE(attempt.Promised(2, {2, {9, 0}, std::nullopt, std::nullopt, {1, 2}, 12}));
  ASSERT_TRUE(attempt.bound().has_value());
  EXPECT_EQ(attempt.bound()->digest, 6U);
  EXPECT_EQ(attempt.newest(), (Place{1, 4}));
  EXPECT_EQ(attempt.digest(), 14U);
  EXPECT_FALSE(attempt.Accepted(0));  // nothing is proposed yet
  attempt.Propose(Of(6));
  EXPECT_FALSE(attempt.Accepted(0));
  EXPECT_FALSE(attempt.Accepted(0));
  EXPECT_FALSE(attempt.Accepted(3));
  EXPECT_TRUE(attempt.Accepted(4));
}

// Any order of messages, any losses: one value at most is ever decided.
TEST(Register, IsWrittenOnce) {
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    std::mt19937_64 random(seed);
    const size_t robots = 3 + random() % 3;
    std::vector<Voter> voters(robots);
    std::vector<Attempt> attempts;
    std::vector<bool> ready;
    std::set<uint64_t> decided;
    for (int step = 0; step < 60; ++step) {
      if (attempts.size() < 4 && random() % 6 == 0) {
        attempts.emplace_back(2, Ballot{1 + random() % 4, static_cast<uint32_t>(attempts.size())}, robots,
                              robots / 2 + 1);
        ready.push_back(false);
      }
      if (attempts.empty()) continue;
      const size_t a = random() % attempts.size();
      const auto robot = static_cast<uint32_t>(random() % robots);
      Voter& voter = voters[robot];
      if (!ready[a]) {
        if (!voter.Prepare(attempts[a].ballot())) continue;
        if (!attempts[a].Promised(robot, {2, attempts[a].ballot(), voter.accepted, voter.value, {1, 0}, 0}))
          continue;
        ready[a] = true;
        attempts[a].Propose(attempts[a].bound() ? *attempts[a].bound() : Of(100 + a));
      } else if (voter.Accept(attempts[a].ballot(), *attempts[a].value()) && attempts[a].Accepted(robot)) {
        decided.insert(attempts[a].value()->digest);
      }
    }
    EXPECT_LE(decided.size(), 1U) << seed;
  }
}

}  // namespace
}  // namespace rondo::runtime::rounds
