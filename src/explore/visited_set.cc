#include "explore/visited_set.h"

#include <algorithm>

namespace rondo::explore {

VisitedSet::VisitedSet(size_t words, bool compact) : words_(compact ? 1 : words), compact_(compact) {
  table_.resize(1024);
}

uint64_t VisitedSet::Hash(std::span<const Word> state) {
  uint64_t h = 0x9e3779b97f4a7c15u;
  for (const Word w : state) {
    h = (h ^ w) * 0xff51afd7ed558ccdu;
    h ^= h >> 29;
  }
  h *= 0xc4ceb9fe1a85ec53u;
  return h ^ (h >> 32);
}

void VisitedSet::Grow() {
  table_ = std::vector<uint32_t>(table_.size() * 2);
  const size_t mask = table_.size() - 1;
  for (size_t i = 0; i < count_; ++i) {
    const Word* state = Stored(i);
    size_t at = (compact_ ? *state : Hash({state, words_})) & mask;
    while (table_[at] != 0) at = (at + 1) & mask;
    table_[at] = static_cast<uint32_t>(i + 1);
  }
}

uint32_t VisitedSet::Insert(std::span<const Word> state, bool& fresh) {
  const uint64_t hash = Hash(state);
  const std::span<const Word> key = compact_ ? std::span<const Word>(&hash, 1) : state;
  if (Full()) Grow();
  const size_t mask = table_.size() - 1;
  size_t at = hash & mask;
  for (; table_[at] != 0; at = (at + 1) & mask) {
    const size_t i = table_[at] - 1;
    if (std::equal(key.begin(), key.end(), Stored(i))) {
      fresh = false;
      return static_cast<uint32_t>(i);
    }
  }
  fresh = true;
  if (count_ % kBlock == 0) blocks_.push_back(std::make_unique_for_overwrite<Word[]>(kBlock * words_));
  std::copy(key.begin(), key.end(), Stored(count_));
  table_[at] = static_cast<uint32_t>(++count_);
  return static_cast<uint32_t>(count_ - 1);
}

bool VisitedSet::Is(std::span<const Word> state, uint32_t number) const {
  const Word* stored = Stored(number);
  return compact_ ? *stored == Hash(state) : std::equal(state.begin(), state.end(), stored);
}

}  // namespace rondo::explore
