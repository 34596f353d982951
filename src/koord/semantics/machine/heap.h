#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rondo::koord::semantics {

/// A value, or a part of one: an int64, a double, a truth value, the number of an enumeration's member, or a
/// handle of a heap entry. Static types say which.
using Word = uint64_t;

inline Word FromInt(int64_t value) { return static_cast<Word>(value); }
inline int64_t ToInt(Word word) { return static_cast<int64_t>(word); }
Word FromFloat(double value);
double ToFloat(Word word);

/// Immutable sequences of words, each stored once: lists, strings, and values that only functions look into.
/// Equal sequences have equal handles, so values are compared word by word. The handle of the empty sequence
/// is 0.
class Heap {
 public:
  Heap();

  Word Intern(std::span<const Word> words);
  /// Valid until the entry is freed.
  std::span<const Word> operator[](Word handle) const {
    const Entry& e = entries_[handle];
    return {e.words.get(), e.size};
  }
  Word InternText(std::string_view text);
  std::string Text(Word handle) const;

  /// Entries that exist now are never freed.
  void Pin() { pinned_ = entries_.size(); }
  /// Frees every entry that is neither pinned nor marked. Call `Mark` for each handle that is in use first.
  void Mark(Word handle) { entries_[handle].marked = true; }
  bool marked(Word handle) const { return entries_[handle].marked; }
  void Sweep();
  size_t words_in_use() const { return words_; }

 private:
  struct Entry {
    std::unique_ptr<Word[]> words;
    uint32_t size = 0;
    uint32_t hash = 0;
    bool marked = false;
    bool used = false;
  };
  void Grow();

  std::vector<Entry> entries_;
  std::vector<uint32_t> free_;
  std::vector<uint32_t> table_;  // open addressing: number of the entry + 1, or 0
  size_t pinned_ = 0;
  size_t live_ = 0;
  size_t words_ = 0;
};

}  // namespace rondo::koord::semantics
