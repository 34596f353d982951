#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Stores the values of programs that do not fit into one word.
namespace rondo::koord::semantics {

/// Holds a value, or a part of one: an int64, a double, a truth value, the number of an enumeration's member,
/// or the handle of a heap entry. Static types say which.
using Word = uint64_t;

inline Word FromInt(int64_t value) { return static_cast<Word>(value); }
inline int64_t ToInt(Word word) { return static_cast<int64_t>(word); }
Word FromFloat(double value);
double ToFloat(Word word);

/// Stores immutable sequences of words, each once: lists, strings, and values that only functions look into.
/// Equal sequences have equal handles, so values are compared word by word. The handle of the empty sequence
/// is 0.
class Heap {
 public:
  Heap();

  /// Returns the handle of the sequence, and stores it if it is new. Expected cost: linear in its length.
  Word Intern(std::span<const Word> words);
  /// Returns the words of an entry, valid until it is freed.
  std::span<const Word> operator[](Word handle) const {
    const Entry& e = entries_[handle];
    return {e.words.get(), e.size};
  }
  /// Stores a text, as `Intern` does a sequence, and `Text` returns it.
  Word InternText(std::string_view text);
  std::string Text(Word handle) const;

  /// Keeps all entries that exist now from ever being freed.
  void Pin() { pinned_ = entries_.size(); }
  /// Marks an entry as in use. Before `Sweep`, every handle that is in use must be marked, also those within
  /// entries.
  void Mark(Word handle) { entries_[handle].marked = true; }
  bool marked(Word handle) const { return entries_[handle].marked; }
  /// Frees every entry that is neither pinned nor marked, and clears all marks. Their memory serves new ones.
  void Sweep();
  /// Returns roughly how many words the entries take, so that owners can tell when to collect.
  size_t words_in_use() const { return words_; }

 private:
  struct Entry {
    std::unique_ptr<Word[]> words;
    uint32_t capacity = 0;  // of `words`, which a freed entry keeps for the next one
    uint32_t size = 0;
    uint32_t hash = 0;
    bool marked = false;
    bool used = false;
  };
  void Grow();
  size_t Free(size_t size);

  std::vector<Entry> entries_;
  std::array<std::vector<uint32_t>, 33> free_;  // by the width of their capacity
  std::vector<uint32_t> table_;                 // open addressing: number of the entry + 1, or 0
  size_t pinned_ = 0;
  size_t live_ = 0;
  size_t words_ = 0;
  std::vector<Word> text_;  // kept for its memory
};

}  // namespace rondo::koord::semantics
