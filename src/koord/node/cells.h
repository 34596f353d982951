#pragma once

#include "koord/node/values.h"
#include "koord/semantics/team.h"

/// The cells of a team's state, as frames name them.
namespace rondo::koord::node {

/// Names an item of an array, or a variable that is none; `stopped` of a robot is a cell of its own.
struct Cell {
  uint32_t variable = 0;
  uint32_t item = 0;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// Finds, reads and writes cells of states. Cells of the block of a robot are encoded without the robot.
class Cells {
 public:
  explicit Cells(semantics::Team& team);

  /// Returns the cell at an address of a state, which is one of a variable's or a mark `stopped`.
  Cell At(uint32_t address) const;
  /// Returns the first address of a cell, that of this robot if each has one; `Width`: how many words it has.
  uint32_t Address(Cell cell, size_t robot) const;
  uint32_t Width(Cell cell) const;
  VariableKind Kind(Cell cell) const;
  /// Returns all cells that all robots share, and all that each robot has, in order.
  const std::vector<Cell>& shared() const { return shared_; }
  const std::vector<Cell>& own() const { return own_; }
  const std::vector<Cell>& sensors() const { return sensors_; }

  /// Appends a cell with the value that these words are, as a change of the one in a state; `robot`: whose it is, if each
  /// has one.
  void Encode(Cell cell, size_t robot, std::span<const Word> state, std::span<const Word> words,
              runtime::codec::Writer& writer) const;
  /// Reads a cell and its value. The reader fails if there is no such cell.
  Cell Decode(size_t robot, std::span<const Word> state, runtime::codec::Reader& reader,
              std::vector<Word>& words) const;
  /// Appends, reads the value alone.
  void EncodeValueOf(Cell cell, std::span<const Word> words, runtime::codec::Writer& writer) const;
  void DecodeValueOf(Cell cell, runtime::codec::Reader& reader, std::vector<Word>& words) const;

 private:
  uint32_t stopped() const { return static_cast<uint32_t>(team_.model().variables.size()); }

  semantics::Team& team_;
  std::vector<Cell> shared_, own_, sensors_;
  std::vector<Cell> by_word_;  // of shared memory, and then of a block
};

}  // namespace rondo::koord::node
