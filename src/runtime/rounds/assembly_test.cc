#include "runtime/rounds/assembly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rondo::runtime::rounds {
namespace {

using codec::Bytes;
using codec::kPart;
using codec::Part;

Bytes Whole(size_t size) {
  Bytes bytes(size);
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * 7 + i / 256);
  return bytes;
}

std::vector<Part> PartsOf(const Bytes& whole) {
  std::vector<Part> parts;
  for (uint32_t from = 0; size_t{from} * kPart <= whole.size(); from += 64)
    ForParts(codec::What::kStore, {1, 2}, std::nullopt, whole, from, UINT64_MAX,
             [&](const Part& p) { parts.push_back(p); });
  return parts;
}

TEST(Assembly, PartsComeInAnyOrderAndMoreThanOnce) {
  for (const size_t size : {size_t{0}, size_t{1}, kPart - 1, kPart, kPart + 1, 5 * kPart, 150 * kPart + 3}) {
    const Bytes whole = Whole(size);
    std::vector<Part> parts = PartsOf(whole);
    EXPECT_EQ(parts.size(), std::max<size_t>(1, (size + kPart - 1) / kPart));
    std::shuffle(parts.begin(), parts.end(), std::mt19937_64(size));
    Assembly assembly;
    for (size_t i = 0; i < parts.size(); ++i) {
      EXPECT_FALSE(assembly.complete());
      EXPECT_EQ(assembly.Add(parts[i]), i + 1 == parts.size());
      assembly.Add(parts[i]);
    }
    EXPECT_TRUE(assembly.complete());
    EXPECT_EQ(assembly.whole(), whole);
  }
}

TEST(Assembly, SaysWhatIsMissing) {
  const Bytes whole = Whole(70 * kPart);
  const std::vector<Part> parts = PartsOf(whole);
  Assembly assembly;
  uint32_t from = 9;
  uint64_t window = 0;
  assembly.Missing(from, window);
  EXPECT_EQ(from, 0U);
  EXPECT_EQ(window, UINT64_MAX);
  for (const size_t k : {0, 1, 3, 69}) assembly.Add(parts[k]);
  assembly.Missing(from, window);
  EXPECT_EQ(from, 2U);
  EXPECT_EQ(window, UINT64_MAX & ~uint64_t{2});
  std::vector<uint32_t> sent;
  ForParts(codec::What::kStore, {1, 2}, std::nullopt, whole, from, window,
           [&](const Part& p) { sent.push_back(p.index); });
  EXPECT_EQ(sent.front(), 2U);
  EXPECT_EQ(sent[1], 4U);
}

TEST(Assembly, PartsOfAnotherWholeAreRefused) {
  const Bytes one = Whole(3 * kPart);
  Bytes two = one;
  two[5] ^= 1;
  Assembly assembly;
  assembly.Add(PartsOf(one)[0]);
  EXPECT_FALSE(assembly.Add(PartsOf(two)[1]));
  uint32_t from = 0;
  uint64_t window = 0;
  assembly.Missing(from, window);
  EXPECT_EQ(from, 1U);
  // A sum that does not fit what came: from the beginning.
  Assembly lied;
  std::vector<Part> parts = PartsOf(one);
  for (Part& part : parts) part.sum += 1;
  for (const Part& part : parts) EXPECT_FALSE(lied.Add(part));
  EXPECT_TRUE(lied.Add(PartsOf(Whole(1))[0]));
}

}  // namespace
}  // namespace rondo::runtime::rounds
