#pragma once

#include <optional>
#include <vector>

#include "koord/semantics/program_transition.h"

/// Finds out how a round can have led from one state to another.
namespace rondo::history {

using koord::semantics::Word;

/// Tells what each robot did in a round.
struct Explanation {
  static constexpr int kSkipped = -1;
  std::vector<int> choice;      ///< by robot: which of its effects, or `kSkipped`
  std::vector<bool> could_act;  ///< by robot: it had an event that can be completed and waits for nothing
  std::vector<bool> idle;       ///< by robot: what it alone writes shows that it ran none
};

/// Explains rounds by the rules of the paper (SelectEvent, SkipEvent, EventTrans): each robot runs one
/// enabled event or skips; all read the state at the start, with what their sensors say in the state at the
/// end; each event has at most one holder of its lock; in one order of the robots, who writes last wins.
class Explainer {
 public:
  explicit Explainer(koord::semantics::Team& team);

  /// Returns how `after` follows from `before`; nothing if it does not.
  /// @param init  it is the one execution of `init`, in which nobody skips.
  /// @param may_skip  by robot: it takes no part, so that it skips whatever is urgent.
  /// @param fallen  by robot: the state in which it fell back last, or nothing. What fallbacks set may have become part
  /// of the state at any moment since.
  /// @param waits  by robot: events that it says it leaves out, because functions that they ask are not finished.
  std::optional<Explanation> Explain(std::span<const Word> before, std::span<const Word> after, bool init,
                                     const std::vector<bool>& may_skip,
                                     const std::vector<std::vector<Word>>& fallen = {},
                                     const std::vector<std::vector<uint32_t>>& waits = {});

 private:
  static bool Writes(const koord::semantics::Effect* effect, uint32_t at);
  bool Fits(size_t robot, const koord::semantics::Effect* effect);
  bool Try(size_t robot);
  bool Waits(size_t robot, uint32_t event) const;
  bool Locks();
  bool LastWriters();

  koord::semantics::Team& team_;
  koord::semantics::ProgramTransition transition_;
  std::vector<size_t> sensors_;  // variables
  std::vector<bool> covered_;    // by word of a robot's block: an actuator with a fallback
  std::vector<Word> start_;      // the state at the start, with the sensors of this round
  std::span<const Word> after_;
  std::vector<std::vector<int>> options_;  // by robot: what fits what it alone writes
  Explanation found_;
  bool init_ = false;
  const std::vector<bool>* may_skip_ = nullptr;
  const std::vector<std::vector<Word>>* fallen_ = nullptr;
  const std::vector<std::vector<uint32_t>>* waits_ = nullptr;
  size_t tried_ = 0;
};

}  // namespace rondo::history
