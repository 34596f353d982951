#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace rondo::base {
namespace {

TEST(ParallelFor, RunsEachItemOnce) {
  for (const unsigned jobs : {0u, 1u, 2u, 7u}) {
    std::vector<std::atomic<int>> hits(100);
    ParallelFor(hits.size(), jobs, [&](size_t i) { ++hits[i]; });
    for (const auto& hit : hits) EXPECT_EQ(hit.load(), 1);
  }
}

TEST(ParallelFor, NothingToDo) {
  ParallelFor(0, 4, [](size_t) { FAIL(); });
  SUCCEED();
}

}  // namespace
}  // namespace rondo::base
