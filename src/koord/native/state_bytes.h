#pragma once

#include <map>
#include <vector>

#include "koord/node/values.h"
#include "koord/semantics/program_transition.h"

/// States and effects of teams as the bytes that programs in C++ know (`program::Core`).
namespace rondo::koord::native {

using runtime::codec::Bytes;
using semantics::Word;

/// Converts the states of a team, which must outlive it.
class StateBytes {
 public:
  explicit StateBytes(semantics::Team& team);

  /// Appends a state.
  void Encode(std::span<const Word> state, Bytes& bytes) const;
  /// Reads one into `state`, which has the words of another. Returns false, with part of it there, if these bytes are none.
  bool Decode(std::span<const uint8_t> bytes, std::span<Word> state) const;

  /// Is a variable that is no array, an item of one, or whether a robot has stopped, as cores number them.
  struct Cell {
    size_t variable;  ///< that of the model; as many as there are: `stopped`
    uint32_t item;
  };
  const std::vector<Cell>& cells() const { return cells_; }
  /// Returns the address of a cell in a state, and the type of its value; `Width`: its words.
  uint32_t AddressOf(Cell cell, size_t robot) const;
  TypeId TypeOf(Cell cell) const;
  uint32_t WidthOf(Cell cell) const;

  /// Returns the value of each cell that an effect writes, by the number of the cell. `before`: the state that it is one of.
  std::map<uint32_t, Bytes> ChangesOf(const semantics::Effect& effect, size_t robot,
                                      std::span<const Word> before) const;

 private:
  template <typename Visit>
  void EachValue(const Visit& visit) const;

  semantics::Team& team_;
  std::vector<Cell> cells_;
};

}  // namespace rondo::koord::native
