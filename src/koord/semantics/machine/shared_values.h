#pragma once

#include <mutex>
#include <unordered_map>
#include <vector>

#include "koord/semantics/machine/layout.h"

/// Lets machines with heaps of their own tell each other states.
namespace rondo::koord::semantics {

/// Numbers values of heaps, equal ones equally, for several threads at once. The empty sequence has number 0.
class SharedValues {
 public:
  SharedValues();
  /// Returns the number of a sequence of words in which numbers stand for handles.
  uint32_t Number(std::span<const Word> words);
  /// Returns the sequence with this number.
  std::vector<Word> Words(uint32_t number) const;
  /// Returns roughly how many words all sequences take.
  size_t words() const;

 private:
  struct Hash {
    size_t operator()(const std::vector<Word>& words) const;
  };
  mutable std::mutex mutex_;
  std::unordered_map<std::vector<Word>, uint32_t, Hash> numbers_;
  std::vector<const std::vector<Word>*> by_number_;
  size_t words_ = 0;
};

/// Translates between the handles of one heap and numbers, and remembers what it has translated: entries of the
/// heap must stay what they are. Used by the thread of the heap.
class HandleExchange {
 public:
  HandleExchange(const lang::TypeTable& types, Heap& heap, SharedValues& shared);

  /// Returns the number of a list, text, array or opaque value of this type.
  Word ToNumber(TypeId type, Word handle);
  /// Returns the handle in this heap of the value with this number, which has this type.
  Word ToHandle(TypeId type, Word number);

 private:
  static uint32_t& Known(std::vector<std::vector<uint32_t>>& by_type, TypeId type, Word value);
  template <typename Translate>
  std::vector<Word> Translated(TypeId type, std::span<const Word> words, const Translate& translate);

  const lang::TypeTable& types_;
  Heap& heap_;
  SharedValues& shared_;
  // By type, since the same words may be values of several, and handle, or number; 0: not known yet.
  std::vector<std::vector<uint32_t>> numbers_, handles_;
};

}  // namespace rondo::koord::semantics
