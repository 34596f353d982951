#pragma once

#include <span>
#include <vector>

#include "koord/node/cells.h"

/// What the actuators of one robot were told, which is not always what the team agreed on.
namespace rondo::koord::node {

/// Keeps the actuators of modules with a fallback apart from the store where they are: from when the robot falls back, or does
/// not act on a round that it took part in, until it has told the team. All others follow the store when the robot acts.
class Commands {
 public:
  Commands(const semantics::Team& team, const Cells& cells, uint32_t robot);

  /// Returns the actuators with a fallback.
  const std::vector<Cell>& covered() const { return covered_; }
  bool IsCovered(Cell cell) const;

  /// Begins a life with this state. Before the robot acts or falls back first, nothing is known of its actuators.
  void Reset(std::span<const Word> state);
  /// Says that the fallbacks left this state, with the sensors of the moment.
  void FallBack(std::span<const Word> state);
  /// Says that the robot is about to tell what it does next. Returns the actuators that it has to tell as well, because they
  /// are not as in the store; their values are in `real`.
  const std::vector<Cell>& Tell(std::span<const Word> store);
  /// Says that the store is now that of the round in which it told, and that its event wrote these cells.
  void Apply(std::span<const Cell> written);
  /// Says that the store came from another robot.
  void Load();
  /// Says that the robot acts on the store. Returns the actuators that get what it says.
  const std::vector<Cell>& Act(std::span<const Word> store);

  /// Returns the state when the robot fell back last, with its actuators since.
  const std::vector<Word>& real() const { return real_; }

 private:
  const Cells& cells_;
  uint32_t robot_;
  std::vector<Cell> actuators_;  // all
  std::vector<Cell> covered_;
  std::vector<Cell> due_;   // written, but not yet acted on
  bool all_due_ = true;     // of those that are not covered, or of all if it has not begun
  bool begun_ = false;      // it acted, or fell back
  bool overtaken_ = false;  // it fell back since it told last
  std::vector<Word> real_;
  std::vector<Cell> apart_, driven_;  // what is returned
};

}  // namespace rondo::koord::node
