#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "koord/semantics/machine/layout.h"

namespace rondo::koord::semantics {

/// States in few bits, exactly: a truth value takes one, a member of an enumeration eight, anything else 32;
/// large ints and all floats are numbered.
class Packing {
 public:
  /// `flags`: bits beside the state.
  Packing(const Layout& layout, uint32_t flags);

  size_t words() const { return words_; }
  void Pack(std::span<const Word> state, Word flags, std::span<Word> packed);
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
