#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/team.h"

namespace rondo::koord::semantics {

/// The environment (rules EnvTrans, RobotEnv) where sensors take values from declared finite sets: at any
/// moment until the next round, each robot's sensors have any declared values that the controller assumptions
/// allow.
class Environment {
 public:
  /// Reports sensors whose values are not declared.
  Environment(Team& team, diag::Diagnostics& diagnostics);

  using Visit = std::function<bool(std::span<const Word>)>;
  /// Calls `visit` for each state that the environment can make of `settled`, the end of the program
  /// transition. False if `visit` was.
  bool Move(std::span<const Word> settled, const Visit& visit);
  /// During the last `Move`: the first robot whose sensors could not take any value, or -1.
  int stuck() const { return stuck_; }

  /// Every state with declared initial values, before `init`.
  bool Declared(const Visit& visit);
  /// A fault in the code of an initial value or list of choices.
  Fault fault() const { return fault_; }
  diag::Span fault_span() const { return fault_span_; }

  /// May the state begin a run? After `init`: `assume initially` and what ports always keep.
  bool MayBegin(std::span<const Word> state);

 private:
  struct Choice {
    size_t variable;
    uint32_t at;  // in the block, or in shared memory
    uint32_t width;
  };
  bool Values(size_t variable, size_t robot, std::vector<Word>& values);
  bool Allowed(size_t robot, const Word* old);
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
