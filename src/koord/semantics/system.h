#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/transition_system.h"
#include "koord/semantics/environment.h"
#include "koord/semantics/machine/packing.h"
#include "koord/semantics/program_transition.h"

namespace rondo::koord::semantics {

struct SystemOptions {
  bool reduce = true;          ///< false: every order of the robots, one after the other
  bool symmetry = true;        ///< where the program allows it
  std::optional<size_t> only;  ///< this invariant alone
};

/// What one robot did in a round.
struct Action {
  size_t robot;
  int event;  ///< -1: it skipped
  std::vector<Effect::Write> writes;
};

/// One transition of a run, told in full.
struct Step {
  bool environment = false;  ///< the sensors moved; else the program transition
  bool complete = true;      ///< false: a part of the robots, before the others
  std::vector<Action> actions;
  std::vector<LastWriter> last_writers;
  std::vector<Word> state;  ///< at its end, unpacked
};

/// What a run can break: the invariants, by number, and behind them:
enum class Trouble : uint8_t { kInvariant, kFault, kSummary };

/// A team of robots as a transition system of packed states. A state is the start of a round or, if there
/// are sensors, also the end of a program transition.
class System {
 public:
  System(Team& team, const SystemOptions& options, diag::Diagnostics& diagnostics);

  size_t words() const { return packing_.words(); }
  explore::Broken Initial(const explore::Visit& visit);
  explore::Broken Successors(std::span<const Word> packed, const explore::Visit& visit);
  bool Deadlocked(std::span<const Word> packed);

  bool symmetric() const { return symmetric_; }
  /// Transitions of a round.
  uint32_t phases() const { return team_.has_sensors() ? 2 : 1; }
  /// Is it the start of a round?
  bool AtRound(std::span<const Word> packed) const { return (packed[0] & 1) == 0 || !team_.has_sensors(); }

  /// What the number of a broken property means.
  Trouble TroubleOf(int property) const;
  /// Of the last fault or broken summary.
  struct Detail {
    Fault fault = Fault::kNone;
    diag::Span span;
    size_t robot = 0;
    int event = -1;  ///< -1: initial values
    int summary = -1;
  };
  const Detail& detail() const { return detail_; }
  /// The environment had no allowed values somewhere: the robot, and the state.
  const std::optional<size_t>& stuck() const { return stuck_; }
  /// Invariants that met an operation without a value in some state: there, they were not checked.
  const std::vector<bool>& undefined() const { return undefined_; }
  /// States that the declarations allow but the assumptions do not.
  uint64_t refused_initial() const { return refused_; }

  /// A run along packed states, told in full. With symmetry, states are only given up to renaming; the run is
  /// one of concrete robots. If `broken` is not at the last state, the step that breaks it is added.
  std::vector<Step> Explain(const std::vector<std::vector<Word>>& path, const explore::Broken& broken);

  /// Calls `visit` for each step from `state`, told in full, until it returns true.
  void StepFrom(std::span<const Word> state, bool environment, const std::function<bool(const Step&)>& visit);
  /// Lists what follows `state`, the start of a round, for what breaks on the way.
  explore::Broken Try(std::span<const Word> state);
  /// Is there a moment of the program transition from `state`, complete or not, that `is` it?
  bool HasPrefix(std::span<const Word> state, const std::function<bool(std::span<const Word>)>& is);

  std::vector<Word> Unpack(std::span<const Word> packed) const;
  /// The first invariant that does not hold, or -1.
  int Violated(std::span<const Word> state);

  /// By event: in how many expanded states some robot could run it.
  const std::vector<uint64_t>& enabled() const { return enabled_; }

 private:
  bool Emit(std::span<const Word> state, Word phase, const explore::Visit& visit, explore::Broken& broken);
  explore::Broken Expand(std::span<const Word> state, Word phase, const explore::Visit& visit);
  explore::Broken Program(std::span<const Word> state, const explore::Visit& visit);
  explore::Broken Failure(Fault fault, diag::Span span, size_t robot, int event);
  bool SummaryBroken(explore::Broken& broken);
  void Canonical(std::span<const Word> state);
  Step Tell(bool complete) const;

  Team& team_;
  SystemOptions options_;
  Environment environment_;
  ProgramTransition transition_;
  Packing packing_;
  bool symmetric_;
  std::vector<Word> state_;
  std::vector<Word> packed_;
  std::vector<Word> canonical_;
  Detail detail_;
  std::optional<size_t> stuck_;
  uint64_t refused_ = 0;
  std::vector<uint64_t> enabled_;
  std::vector<bool> undefined_;
  std::vector<Word> emitted_;  // the last state, before symmetry
};

static_assert(explore::TransitionSystem<System>);

}  // namespace rondo::koord::semantics
