#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/choices.h"
#include "koord/semantics/team.h"

/// Lists what a team may do in the program transition of one round.
namespace rondo::koord::semantics {

/// Holds what one enabled event of one robot does, in terms of the values at the start of the round.
struct Effect {
  uint32_t event;
  bool urgent;
  bool locks;
  Fault fault;  ///< why the event cannot be completed; kNone if it can
  diag::Span fault_span;
  bool idle;  ///< it changes nothing and takes no lock, so that it is the same as a skip
  struct Write {
    uint32_t at;
    Word value;
  };
  std::vector<Write> own;  ///< to the robot's own block, at addresses of the state
  struct Shared {
    Machine::Unit unit;
    uint32_t values;  ///< the new words are in `words` from here
  };
  std::vector<Shared> shared;  ///< to variables and cells that every robot may write
  std::vector<Word> words;
  std::vector<Said> said;  ///< to streams, if the machine keeps that (`Machine::KeepSaid`)
};

/// Tells who wrote a variable or cell last where several robots wrote different values to it.
struct LastWriter {
  Machine::Unit unit;
  size_t robot;
};

/// Enumerates the program transition of a round (rules SelectEvent, SkipEvent, EventTrans, EndProgTrans):
/// every robot runs one enabled event or skips, all read the values at the start, at most one robot holds the
/// lock of an event, and what every robot may write keeps the value of its last writer. The events of a round
/// commute but for last writers and locks, so orders are not enumerated (docs/theory.md, "Exploration").
class ProgramTransition {
 public:
  explicit ProgramTransition(Team& team);
  ProgramTransition(const ProgramTransition&) = delete;
  ProgramTransition& operator=(const ProgramTransition&) = delete;

  /// Finds what each robot can do in `state` by running its enabled events there. The state must stay as it
  /// is until the last `Enumerate`.
  void Prepare(std::span<const Word> state);
  /// Does the same for one robot alone; the others have no effects then.
  void Prepare(std::span<const Word> state, size_t robot);
  /// Does the same for the one execution of `init` by every robot, before the first round.
  void PrepareInit(std::span<const Word> state);

  /// Returns the effects of the enabled events of robot `robot`: several of one event, where `any` has
  /// several values.
  std::span<const Effect> Of(size_t robot) const { return {effects_[robot].data(), counts_[robot]}; }
  /// Reports whether some robot has an enabled event.
  bool AnyEnabled() const;
  /// Returns the first effect that cannot be completed, and puts its robot into `robot`; nullptr if there is
  /// none.
  const Effect* Failed(size_t* robot) const;

  /// Calls `visit(state, complete)` for each state in which the events of a round can leave the team, before
  /// the environment moves; not complete: a robot still has to run an urgent event. Ends when `visit` returns
  /// false. A state may be visited more than once.
  using Visit = std::function<bool(std::span<const Word>, bool)>;
  bool Enumerate(const Visit& visit);
  /// Does the same without the reduction: visits every order of the robots and every prefix of it.
  /// Exponential in the number of robots, and meant for tests of the reduction.
  bool EnumerateOrders(const Visit& visit);

  /// Says that robots can be renamed (`IsSymmetric`), so that of neighbours in the same state only one order
  /// of their choices is visited.
  void TreatAlike(bool alike) { alike_ = alike; }

  static constexpr int kSkips = -1;
  /// Returns, during `visit`, which effect of `Of` each robot chose, or `kSkips`; and who wrote last where
  /// several robots did.
  const std::vector<int>& choice() const { return choice_; }
  const std::vector<LastWriter>& last_writers() const { return last_; }

 private:
  void Start(std::span<const Word> state);
  void Find(size_t robot);
  void Run(size_t robot, uint32_t event, uint32_t entry, Effect& effect);
  void RunInits(size_t robot, Effect& effect);
  template <typename Way>
  void Each(const Way& way);
  Effect& Next(size_t robot);
  bool Choose(size_t robot, const Visit& visit);
  bool MaySkip(size_t robot) const;
  bool Complete() const;
  bool Settle(const Visit& visit);
  bool Resolve(const Visit& visit, bool complete);
  bool Order(size_t done, const Visit& visit);
  void Apply(const Effect& effect, std::vector<Machine::Write>& undo, bool shared);
  void TakeBack(std::vector<Machine::Write>& undo, size_t from);

  struct Conflict {
    Machine::Unit unit;
    std::vector<size_t> writers;  // robots
    int winner = -1;
  };

  Team& team_;
  bool init_ = false;
  std::vector<Word> memory_;
  Choices choices_;                           // of the event that is running
  std::vector<std::vector<Effect>> effects_;  // by robot; more than `counts_` are kept for their memory
  std::vector<size_t> counts_;
  std::vector<int> choice_;
  std::vector<int> lock_holder_;  // by event
  std::vector<bool> acted_;
  std::vector<Machine::Write> undo_;
  std::vector<Conflict> units_;
  size_t unit_count_ = 0;
  std::vector<LastWriter> last_;
  bool any_urgent_ = false;
  bool alike_ = false;
  std::vector<bool> like_previous_;  // by robot
};

}  // namespace rondo::koord::semantics
