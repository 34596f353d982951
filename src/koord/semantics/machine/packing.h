#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "koord/semantics/machine/layout.h"

/// Packs states for the tables of a search.
namespace rondo::koord::semantics {

/// Packs states into few bits, without loss: a truth value takes one bit, a member of an enumeration eight,
/// anything else 32. Ints beyond 30 bits and floats are numbered as they come, so that packed states compare
/// equal exactly if the states do, but only for one and the same `Packing`.
/// @error ends the program when there are more than 2^31 different numbers.
class Packing {
 public:
  /// Prepares for states of `layout`, with `flags` further bits that stand in front of each.
  Packing(const Layout& layout, uint32_t flags);

  /// Returns how many words a packed state has.
  size_t words() const { return words_; }
  /// Writes the packed form of a state to `packed`, which has `words()` words.
  void Pack(std::span<const Word> state, Word flags, std::span<Word> packed);
  /// Restores the state that `Pack` packed, and its flags.
  void Unpack(std::span<const Word> packed, std::span<Word> state, Word& flags) const;

 private:
  struct Field {
    WordKind kind;
    uint8_t shift;
    uint32_t word;
  };
  Word Number(Word value);

  std::vector<Field> fields_;
  uint32_t flags_;
  size_t words_ = 0;
  std::unordered_map<Word, uint32_t> number_;
  std::vector<Word> numbered_;
};

}  // namespace rondo::koord::semantics
