#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/team.h"

/// Lists what the environment may do in one step of an exploration.
namespace rondo::koord::semantics {

/// Enumerates the environment's transitions and the initial states (rules EnvTrans, RobotEnv) where sensors
/// take values from declared finite sets: at any moment until the next round, each robot's sensors have any
/// declared values that the controller assumptions allow. Actuators and all other variables stay as they are.
class Environment {
 public:
  /// Reports each sensor whose values are not declared, unless its type has finitely many (truth values and
  /// enumerations).
  Environment(Team& team, diag::Diagnostics& diagnostics);

  /// Receives a state, which is valid during the call. Returns whether to go on.
  using Visit = std::function<bool(std::span<const Word>)>;
  /// Calls `visit` for each state that the environment can make of `settled`, the end of the program
  /// transition. Returns false if `visit` did. Visits nothing if a robot is `stuck` or declared values have a
  /// `fault`.
  /// @param over  the round is: what is promised `finally` holds, too.
  bool Move(std::span<const Word> settled, bool over, const Visit& visit);
  /// Returns the first robot for whose sensors the last `Move` found no values that the assumptions allow; -1
  /// if there is none.
  int stuck() const { return stuck_; }

  /// Calls `visit` for each state before `init`: declared values where there are any, each declared choice
  /// elsewhere, and what `assume initially` determines.
  bool Declared(const Visit& visit);
  /// Returns why the code of an initial value or of a list of choices has no value, and where; kNone if that
  /// did not happen.
  Fault fault() const { return fault_; }
  diag::Span fault_span() const { return fault_span_; }

  /// Reports whether a run may begin in the state, the one after `init`: `assume initially` holds, and so do
  /// the controller assumptions that hold at every moment.
  bool MayBegin(std::span<const Word> state);

 private:
  struct Choice {
    size_t variable;
    uint32_t at;  // in the block, or in shared memory
    uint32_t width;
  };
  bool Values(size_t variable, size_t robot, std::vector<Word>& values);
  bool Allowed(size_t robot, const Word* old, bool over);
  bool Product(size_t robot, const Visit& visit);
  bool Initialise(size_t index, size_t robot, const Visit& visit);
  bool Assign(const std::vector<InitialCode>& code);

  Team& team_;
  std::vector<Choice> sensors_;
  std::vector<Word> memory_;
  std::vector<Word> old_;
  std::vector<std::vector<std::vector<Word>>> sets_;  // by robot and sensor: the declared values
  std::vector<std::vector<Word>> allowed_;            // by robot: tuples of values of its sensors
  size_t tuple_ = 0;
  struct Start {
    size_t variable;
    size_t robot;
  };
  std::vector<Start> starts_;  // whose initial value is chosen
  int stuck_ = -1;
  Fault fault_ = Fault::kNone;
  diag::Span fault_span_;
};

}  // namespace rondo::koord::semantics
