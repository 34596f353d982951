#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/team.h"

namespace rondo::koord::semantics {

/// What one enabled event of one robot does, in terms of the values at the start of the round.
struct Effect {
  uint32_t event;
  bool urgent;
  bool locks;
  Fault fault;  ///< it cannot be completed
  diag::Span fault_span;
  bool idle;  ///< it changes nothing and takes no lock: like a skip
  struct Write {
    uint32_t at;
    Word value;
  };
  std::vector<Write> own;  ///< to the robot's block
  struct Shared {
    Machine::Unit unit;
    uint32_t values;  ///< the new words are in `words` from here
  };
  std::vector<Shared> shared;  ///< to what every robot may write
  std::vector<Word> words;
};

/// One last writer among several.
struct LastWriter {
  Machine::Unit unit;
  size_t robot;
};

/// The program transition of a round (rules SelectEvent, SkipEvent, EventTrans, EndProgTrans): every robot
/// runs one enabled event or skips, all read the values at the start, at most one robot holds the lock of an
/// event, and what every robot may write keeps the value of its last writer. The events of a round commute
/// but for last writers and locks, so orders are not enumerated (docs/theory.md, "Exploration").
class ProgramTransition {
 public:
  explicit ProgramTransition(Team& team);
  ProgramTransition(const ProgramTransition&) = delete;
  ProgramTransition& operator=(const ProgramTransition&) = delete;

  /// Finds what each robot can do in `state`. The state must stay as it is until the last `Enumerate`.
  void Prepare(std::span<const Word> state);
  /// The same for the one execution of `init` by every robot.
  void PrepareInit(std::span<const Word> state);

  /// The effects of robot r's enabled events.
  std::span<const Effect> Of(size_t robot) const { return {effects_[robot].data(), counts_[robot]}; }
  bool AnyEnabled() const;
  /// The first event that cannot be completed, and its robot; or nullptr.
  const Effect* Failed(size_t* robot) const;

  /// Calls `visit(state, complete)` for each state in which the events of a round can leave the team, before
  /// the environment moves; not complete: a robot still has to run an urgent event. Ends when `visit` returns
  /// false. A state may be visited more than once.
  using Visit = std::function<bool(std::span<const Word>, bool)>;
  bool Enumerate(const Visit& visit);
  /// The same without the reduction: every order of the robots, every prefix. For tests.
  bool EnumerateOrders(const Visit& visit);

  /// Robots can be renamed: of neighbours in the same state, one order of their choices is enough.
  void TreatAlike(bool alike) { alike_ = alike; }

  static constexpr int kSkips = -1;
  /// During `visit`: by robot, its effect or `kSkips`; and who wrote last where several did.
  const std::vector<int>& choice() const { return choice_; }
  const std::vector<LastWriter>& last_writers() const { return last_; }

 private:
  void Run(size_t robot, uint32_t event, uint32_t entry, Effect& effect);
  void RunInits(size_t robot, Effect& effect);
  void Each(const std::function<Fault*()>& run);
  uint64_t Pick(uint64_t possibilities);
  bool NextChoices();
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
  struct Picked {
    uint64_t pick;
    uint64_t possibilities;
  };
  std::vector<Picked> picks_;  // by `any`, in the order in which the event that is running meets them
  size_t met_ = 0;
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
