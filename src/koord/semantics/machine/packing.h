#pragma once

#include <span>
#include <vector>

#include "koord/semantics/machine/layout.h"
#include "koord/semantics/machine/shared_values.h"

/// Packs states for the tables of a search.
namespace rondo::koord::semantics {

/// Packs states into few bytes, without loss: a truth value takes one bit, a member of an enumeration a byte, a
/// small int a byte or two, a float as many as its last digits need. Packed states are equal exactly if the
/// states are: for handles, if they stand for equal values, whichever heap these are in.
class Packing {
 public:
  /// Prepares for states of `layout`, with `flags` further bits that stand in front of each.
  /// @param exchange  what handles are translated by; nullptr: they stay as they are.
  Packing(const Layout& layout, uint32_t flags, HandleExchange* exchange = nullptr);

  /// Returns the packed form of a state, valid until the next call.
  std::span<const uint8_t> Pack(std::span<const Word> state, Word flags);
  /// Restores the state that `Pack` packed, and its flags.
  void Unpack(std::span<const uint8_t> packed, std::span<Word> state, Word& flags);
  /// Returns the flags alone, of which there are at most 8.
  Word Flags(std::span<const uint8_t> packed) const { return packed[0] & ((1u << flags_) - 1); }

 private:
  // A word of a state that is more than a bit.
  struct Field {
    Layout::Slot slot;
    uint32_t word;
  };
  std::vector<Field> fields_;
  std::vector<uint32_t> bits_;  // words that are truth values
  uint32_t flags_;
  size_t head_;  // bytes of flags and truth values
  HandleExchange* exchange_;
  std::vector<uint8_t> packed_;
};

}  // namespace rondo::koord::semantics
