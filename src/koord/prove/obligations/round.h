#pragma once

#include <map>
#include <string>
#include <vector>

#include "koord/prove/execution/executor.h"
#include "solve/solver.h"

/// States what one round can do, as formulas for a solver.
namespace rondo::koord {

/// Says what rounds in which robots are cut off leave out.
struct CutOffLimits {
  bool acts_at_once = false;  ///< events reach actuators as the round begins, or never
  bool runs_urgent = false;   ///< who has an urgent event to run is not cut off
};

/// States one round, or the execution of `init` by every robot, as a relation between the state at its start
/// and a state at any later moment of it (docs/theory.md, "The round"):
/// - each robot runs at most one event, or skips; all read the values at the start (EventTrans, SkipEvent);
/// - what every robot may write takes the value of the last writer in an order that is the same for all
/// variables;
/// - one robot at most takes the lock of an event (atomic);
/// - then the environment may have moved the sensors, within the controller assumptions (EnvTrans).
/// A robot that has not run yet is one that skips, so the relation covers every prefix of the interleaving.
///
/// Of robots that can be cut off from the others (kCutOff), actuators follow on their own: what the event of a robot
/// writes reaches them at once, later, or never, and its fallback may take over at any moment (docs/theory.md, "Robots that
/// are cut off").
///
/// The relation is stated for chosen robots, the participants: the others do not matter to a formula that
/// does not read their state, except as last writers, and those are participants of their own.
class Round {
 public:
  /// Says which transition it is: the events of a round, or `init` of every robot; or the events of a round in which
  /// robots may be cut off.
  enum class Kind : uint8_t { kEvents, kInit, kCutOff };

  /// @param limits  of kCutOff: what is not looked at.
  Round(Vocabulary& vocabulary, Executor& executor, Kind kind, CutOffLimits limits = {});

  /// Returns the state at the start of the round, and the one at the moment that the relation leads to.
  const View& start() const { return start_; }
  const View& end() const { return end_; }
  /// Returns the state at which the environment takes over: sensors as at the start, everything else as at
  /// the end.
  const View& settled() const { return settled_; }
  /// Returns whether the environment has moved already.
  TermId moved() const { return moved_; }
  /// Holds a time in which actuators of a robot stay as they are: unless `still`, controllers keep what they promise
  /// at `from` until `to`.
  struct Leg {
    TermId still;
    View from, to;
  };
  /// Returns, of kCutOff: when each robot's actuators change, the state as far as it is this robot's; and of a robot,
  /// whether what its event writes does not reach its actuators before, whether they change at all, and whether by its
  /// fallback.
  const View& then() const { return then_; }
  TermId Waits(TermId robot) { return If(waits_, robot); }
  TermId Changes(TermId robot) { return If(changes_, robot); }
  TermId FallsBack(TermId robot) { return If(falls_back_, robot); }
  /// Returns the states at moments of the round behind its start.
  std::vector<View> moments() const {
    return kind_ == Kind::kCutOff ? std::vector<View>{then_, end_} : std::vector<View>{end_};
  }
  /// Returns the legs of a round, as one robot goes them.
  std::vector<Leg> Legs(TermId robot);

  /// Returns the names of the actions of this round: `skip` first (unless it is `init`), then the events.
  const std::vector<std::string>& actions() const { return actions_; }
  /// Returns the formula that the robot takes this action in the round.
  TermId Acts(TermId robot, size_t action);
  /// Returns what the action does if this robot takes it.
  const Effect& EffectOf(size_t action, TermId robot);

  /// Makes participants of all robots whose state at the end `goal` reads, and of a last writer for each
  /// variable that all may write and `goal` reads; returns the relation.
  /// @param everyone  the whole team, if the round is to be told in full; else empty.
  /// @param others  participants in any case.
  std::vector<solve::Assertion> Relate(TermId goal, const std::vector<TermId>& everyone,
                                       const std::vector<TermId>& others = {});
  /// Returns the robots that the last `Relate` stated the round for.
  const std::vector<TermId>& participants() const { return participants_; }
  /// Returns the participants without `others`. They follow from the goal (and the team, where that is told
  /// in full) alone, so cases by what they do fit together, whoever else takes part in the proof of one.
  const std::vector<TermId>& readers() const { return readers_; }

 private:
  struct LastWriter {
    size_t variable;
    std::vector<TermId> cell;  // its indices, in an array
    TermId robot;
  };

  void CanBeCutOff(Executor& executor);
  void Participate(TermId robot);
  void FindReads(TermId goal);
  void FindCells(TermId goal);
  TermId PartOf(TermId whole, const LastWriter& last);
  TermId StateOf(TermId robot);
  TermId ActuatorOf(size_t variable, TermId robot, TermId acted);
  TermId Still(const View& from, const View& to, TermId robot);
  TermId If(expr::SymbolId predicate, TermId robot) { return arena_.Apply(predicate, {robot}); }
  TermId Urgency(TermId robot);
  TermId MayChange(TermId robot);
  TermId Locks();
  TermId WriterOf(const LastWriter& last);
  TermId Wrote(TermId robot, const LastWriter& last);
  TermId Written(TermId robot, const LastWriter& last);
  TermId ByAction(TermId robot, const std::function<TermId(const Effect&)>& value, TermId otherwise);

  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  const Model& model_;
  Kind kind_;
  CutOffLimits limits_;
  View start_;
  View end_;
  View settled_;
  TermId moved_;
  // Of kCutOff, by robot: sensors and actuators when its actuators change (arrays of their own, so each robot has its
  // moment); whether what its event writes does not reach them before that; whether they change at all; to what its
  // fallback says, or to what its event wrote.
  View then_;
  expr::SymbolId waits_, changes_, falls_back_;
  std::map<size_t, TermId> fallback_;  // by actuator, for `self_`, at `then_`
  TermId self_;
  expr::SymbolId act_;
  expr::SymbolId turn_;  // the place of a robot in the interleaving
  SortId action_sort_;
  std::vector<std::string> actions_;
  std::vector<Effect> effects_;  // for `self_`, by action; empty for `skip`
  std::map<std::pair<size_t, TermId>, Effect> instances_;
  std::vector<TermId> participants_;
  std::vector<TermId> readers_;
  bool whole_team_ = false;  // are the participants all robots?
  std::vector<LastWriter> writers_;
};

}  // namespace rondo::koord
