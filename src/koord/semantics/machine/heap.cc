#include "koord/semantics/machine/heap.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace rondo::koord::semantics {

Word FromFloat(double value) { return std::bit_cast<Word>(value); }
double ToFloat(Word word) { return std::bit_cast<double>(word); }

namespace {

uint32_t HashOf(std::span<const Word> words) {
  uint64_t h = 0x9e3779b97f4a7c15u ^ words.size();
  for (const Word w : words) {
    h = (h ^ w) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return static_cast<uint32_t>(h);
}

}  // namespace

Heap::Heap() {
  table_.resize(64);
  Intern({});
  Pin();
}

void Heap::Grow() {
  table_.assign(std::max<size_t>(64, std::bit_ceil(live_ * 4)), 0);
  for (size_t i = 0; i < entries_.size(); ++i) {
    if (!entries_[i].used) continue;
    size_t at = entries_[i].hash & (table_.size() - 1);
    while (table_[at] != 0) at = (at + 1) & (table_.size() - 1);
    table_[at] = static_cast<uint32_t>(i + 1);
  }
}

// An entry that is not in use and has room for so many words.
size_t Heap::Free(size_t size) {
  const size_t capacity = size == 0 ? 0 : std::bit_ceil(size);
  std::vector<uint32_t>& free = free_[static_cast<size_t>(std::bit_width(capacity))];
  if (!free.empty()) {
    const size_t index = free.back();
    free.pop_back();
    return index;
  }
  Entry& entry = entries_.emplace_back();
  entry.words = std::make_unique<Word[]>(capacity);
  entry.capacity = static_cast<uint32_t>(capacity);
  return entries_.size() - 1;
}

Word Heap::Intern(std::span<const Word> words) {
  const uint32_t hash = HashOf(words);
  size_t at = hash & (table_.size() - 1);
  for (; table_[at] != 0; at = (at + 1) & (table_.size() - 1)) {
    const Entry& e = entries_[table_[at] - 1];
    if (e.hash == hash && e.size == words.size() && std::equal(words.begin(), words.end(), e.words.get()))
      return table_[at] - 1;
  }
  const size_t index = Free(words.size());
  Entry& entry = entries_[index];
  std::copy(words.begin(), words.end(), entry.words.get());
  entry.size = static_cast<uint32_t>(words.size());
  entry.hash = hash;
  entry.used = true;
  words_ += words.size() + 4;
  ++live_;
  table_[at] = static_cast<uint32_t>(index + 1);
  if (live_ * 2 > table_.size()) Grow();
  return index;
}

Word Heap::InternText(std::string_view text) {
  // The length first: a text may end in zero bytes.
  if (text.empty()) return 0;
  std::vector<Word>& words = text_;
  words.assign(1, text.size());
  for (size_t i = 0; i < text.size(); i += 8) {
    Word w = 0;
    std::memcpy(&w, text.data() + i, std::min<size_t>(8, text.size() - i));
    words.push_back(w);
  }
  return Intern(words);
}

std::string Heap::Text(Word handle) const {
  const auto words = (*this)[handle];
  if (words.empty()) return {};
  std::string text(words[0], '\0');
  std::memcpy(text.data(), words.data() + 1, text.size());
  return text;
}

void Heap::Sweep() {
  for (size_t i = pinned_; i < entries_.size(); ++i) {
    Entry& e = entries_[i];
    if (e.used && !e.marked) {
      words_ -= e.size + 4;
      --live_;
      e.used = false;
      free_[static_cast<size_t>(std::bit_width(e.capacity))].push_back(static_cast<uint32_t>(i));
    }
    e.marked = false;
  }
  for (size_t i = 0; i < pinned_; ++i) entries_[i].marked = false;
  Grow();
}

}  // namespace rondo::koord::semantics
