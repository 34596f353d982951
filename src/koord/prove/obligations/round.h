#pragma once

#include <map>
#include <string>
#include <vector>

#include "koord/prove/execution/executor.h"
#include "solve/solver.h"

/// States what one round can do, as formulas for a solver.
namespace rondo::koord {

/// States one round, or the execution of `init` by every robot, as a relation between the state at its start
/// and a state at any later moment of it (docs/theory.md, "The round"):
/// - each robot runs at most one event, or skips; all read the values at the start (EventTrans, SkipEvent);
/// - what every robot may write takes the value of the last writer in an order that is the same for all
/// variables;
/// - one robot at most takes the lock of an event (atomic);
/// - then the environment may have moved the sensors, within the controller assumptions (EnvTrans).
/// A robot that has not run yet is one that skips, so the relation covers every prefix of the interleaving.
///
/// The relation is stated for chosen robots, the participants: the others do not matter to a formula that
/// does not read their state, except as last writers, and those are participants of their own.
class Round {
 public:
  /// Says which transition it is: the events of a round, or `init` of every robot.
  enum class Kind : uint8_t { kEvents, kInit };

  Round(Vocabulary& vocabulary, Executor& executor, Kind kind);

  /// Returns the state at the start of the round, and the one at the moment that the relation leads to.
  const View& start() const { return start_; }
  const View& end() const { return end_; }
  /// Returns the state at which the environment takes over: sensors as at the start, everything else as at
  /// the end.
  const View& settled() const { return settled_; }
  /// Returns whether the environment has moved already.
  TermId moved() const { return moved_; }

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

  void Participate(TermId robot);
  void FindReads(TermId goal);
  void FindCells(TermId goal);
  TermId PartOf(TermId whole, const LastWriter& last);
  TermId StateOf(TermId robot);
  TermId Urgency(TermId robot);
  TermId Locks();
  TermId WriterOf(const LastWriter& last);
  TermId Wrote(TermId robot, const LastWriter& last);
  TermId Written(TermId robot, const LastWriter& last);
  TermId ByAction(TermId robot, const std::function<TermId(const Effect&)>& value, TermId otherwise);

  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  const Model& model_;
  Kind kind_;
  View start_;
  View end_;
  View settled_;
  TermId moved_;
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
