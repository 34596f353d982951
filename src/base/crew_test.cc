#include "base/crew.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace rondo::base {
namespace {

TEST(Crew, RunsEachItemOnceAsOftenAsItIsAsked) {
  for (const unsigned size : {1u, 2u, 5u}) {
    Crew crew(size);
    EXPECT_EQ(crew.size(), size);
    for (size_t round = 0; round < 300; ++round) {
      std::vector<std::atomic<int>> hits(round % 7 * 10);
      std::vector<std::atomic<int>> at_work(size);
      crew.Run(hits.size(), [&](size_t member, size_t i) {
        EXPECT_EQ(at_work[member]++, 0);
        ++hits[i];
        --at_work[member];
      });
      for (const auto& hit : hits) EXPECT_EQ(hit.load(), 1);
    }
  }
}

TEST(Crew, EndsWithoutWork) {
  const Crew crew(0);
  EXPECT_GE(crew.size(), 1U);
}

}  // namespace
}  // namespace rondo::base
