#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/transition_system.h"
#include "koord/semantics/environment.h"
#include "koord/semantics/machine/packing.h"
#include "koord/semantics/program_transition.h"

/// Gives searches a team of robots as a graph of states.
namespace rondo::koord::semantics {

/// Says which reductions a search uses, and what it checks.
struct SystemOptions {
  bool reduce = true;          ///< false: visits every order of the robots, one after the other
  bool symmetry = true;        ///< states that differ by a renaming count as one, where that is sound
  std::optional<size_t> only;  ///< checks this invariant alone
};

/// Tells what one robot did in a round.
struct Action {
  size_t robot;
  int event;  ///< -1: it skipped
  std::vector<Effect::Write> writes;
};

/// Tells one transition of a run in full.
struct Step {
  bool environment = false;  ///< the sensors moved; false: it is a program transition
  bool complete = true;      ///< false: only some of the robots have run yet, and the others did not skip
  std::vector<Action> actions;
  std::vector<LastWriter> last_writers;
  std::vector<Word> state;  ///< at the end of the transition, unpacked
};

/// Names what a run can break. Properties are numbered: first the invariants in order, then one number for
/// operations without a value (kFault), then one for summaries that a call violates (kSummary).
enum class Trouble : uint8_t { kInvariant, kFault, kSummary };

/// Presents a team of robots as a transition system of packed states (`explore::TransitionSystem`). A state
/// is the start of a round or, if there are sensors, also the end of a program transition; a flag tells which.
class System {
 public:
  /// @param shared  what several systems of one search number the values of their heaps by; nullptr: there is
  /// only this one.
  System(Team& team, const SystemOptions& options, diag::Diagnostics& diagnostics,
         SharedValues* shared = nullptr);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Visits every initial state, those after `init` that the assumptions allow. Returns what is broken on the
  /// way, if anything is; then it ends early.
  explore::Broken Initial(const explore::Visit& visit);
  /// Visits every state that one transition leads to from `packed`. Returns what is broken on the way, if
  /// anything is; then it ends early.
  explore::Broken Successors(explore::State packed, const explore::Visit& visit);
  /// Returns the first invariant that does not hold in a state; -1 if there is none.
  int Check(explore::State packed);
  /// Reports whether nothing can change any more from the start of a round: no event is enabled, not all
  /// robots have stopped, and no move of the environment changes a sensor.
  bool Deadlocked(explore::State packed);

  /// Reports whether states are taken up to a renaming of robots: it was asked for, there are several robots,
  /// and the program allows it.
  bool symmetric() const { return symmetric_; }
  /// Returns how many transitions make a round: 2 with sensors, else 1.
  uint32_t phases() const { return team_.has_sensors() ? 2 : 1; }
  /// Reports whether the state is the start of a round.
  bool AtRound(explore::State packed) const { return packing_.Flags(packed) == 0 || !team_.has_sensors(); }

  /// Returns what the number of a broken property means.
  Trouble TroubleOf(int property) const;
  /// Describes the last fault or violated summary.
  struct Detail {
    Fault fault = Fault::kNone;
    diag::Span span;
    size_t robot = 0;
    int event = -1;  ///< -1: it happened in initial values or `init`
    int summary = -1;
  };
  const Detail& detail() const { return detail_; }
  /// Returns the first robot for whose sensors the assumptions allowed no declared values in some state; nothing if
  /// there was always one.
  const std::optional<size_t>& stuck() const { return stuck_; }
  /// Returns, by invariant, whether it met an operation without a value in some state; there, it was not
  /// checked.
  const std::vector<bool>& undefined() const { return undefined_; }
  /// Returns how many initial states the declarations allow but the assumptions do not.
  uint64_t refused_initial() const { return refused_; }

  /// Returns a run along packed states, told in full. With symmetry, these states are only given up to a
  /// renaming; the run is one of concrete robots. If `broken` is not at the last state, the step that breaks
  /// it is added. Ends early where a state does not follow from the one before.
  std::vector<Step> Explain(const std::vector<explore::KeptState>& path, const explore::Broken& broken);

  /// Calls `visit` for each step from `state`, told in full, until it returns true.
  void StepFrom(std::span<const Word> state, bool environment, const std::function<bool(const Step&)>& visit);
  /// Expands `state`, the start of a round, and returns what breaks in the program transition, if anything
  /// does.
  explore::Broken Try(std::span<const Word> state);
  /// Reports whether `is` accepts some moment of the program transition from `state`, be it complete or not.
  bool HasPrefix(std::span<const Word> state, const std::function<bool(std::span<const Word>)>& is);

  /// Returns the words of a packed state.
  std::vector<Word> Unpack(explore::State packed);
  /// Returns the first invariant that is defined and does not hold in the state; -1 if there is none.
  int Violated(std::span<const Word> state, bool between_rounds);

  /// Returns a bit for each event: whether some robot could run it in the state that was expanded last.
  std::span<const uint64_t> Marks() const { return marks_; }
  /// Adds what another system of the same search met: `undefined`, `stuck`.
  void TakeIn(const System& other);

 private:
  bool Emit(std::span<const Word> state, Word phase, const explore::Visit& visit);
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
  std::optional<HandleExchange> exchange_;
  Packing packing_;
  bool symmetric_;
  std::vector<Word> state_;
  std::vector<Word> checked_;  // apart, since searches check states in the middle of listing others
  std::vector<Word> canonical_;
  Detail detail_;
  std::optional<size_t> stuck_;
  uint64_t refused_ = 0;
  std::vector<uint64_t> marks_;
  std::vector<bool> undefined_;
  std::vector<Word> emitted_;  // the last state, before symmetry
};

static_assert(explore::TransitionSystem<System>);

}  // namespace rondo::koord::semantics
