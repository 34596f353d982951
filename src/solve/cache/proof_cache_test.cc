#include "solve/cache/proof_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/file.h"

namespace rondo::solve::cache {
namespace {

class Cache : public testing::Test {
 protected:
  ~Cache() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path OnlyFile() const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) return entry.path();
    }
    return {};
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("rondo_cache_test_" + std::to_string(::getpid()));
  ProofCache cache_{folder_};
};

TEST_F(Cache, FindsWhatWasStored) {
  EXPECT_FALSE(cache_.Find("(assert false)").has_value());
  cache_.Store("(assert false)\n", {"z3", {"a", "b c"}});
  const auto entry = cache_.Find("(assert false)\n");
  ASSERT_TRUE(entry.has_value());
  EXPECT_EQ(entry->engine, "z3");
  EXPECT_EQ(entry->core, (std::vector<std::string>{"a", "b c"}));
  EXPECT_FALSE(cache_.Find("(assert false) ").has_value());
}

TEST_F(Cache, ADamagedEntryIsAMiss) {
  const std::string question = "(assert false)\n";
  cache_.Store(question, {"z3", {"a"}});
  const auto path = OnlyFile();
  const std::string whole = base::ReadFile(path).value();
  for (size_t keep = 0; keep < whole.size(); ++keep) {
    ASSERT_TRUE(base::WriteFileAtomically(path, whole.substr(0, keep)).ok());
    EXPECT_FALSE(cache_.Find(question).has_value()) << keep;
  }
  // The right name with another question in it: what a hash collision would look like.
  std::string other = whole;
  other[other.size() - 3] = 'X';
  ASSERT_TRUE(base::WriteFileAtomically(path, other).ok());
  EXPECT_FALSE(cache_.Find(question).has_value());
}

}  // namespace
}  // namespace rondo::solve::cache
