#pragma once

#include <string>
#include <vector>

#include "koord/prove/obligations/problem.h"

/// Lists what a proof has to ask, and in which order of effort.
namespace rondo::koord {

/// Names the questions that a proof asks (`Problems` says what each means).
enum class TaskKind : uint8_t {
  kInitially,
  kRound,       // one invariant, any round
  kStep,        // one invariant, the rounds in which one action is the first
  kFollows,     // one invariant, from others at the same moment
  kCutOff,      // one invariant, any round in which robots may be cut off
  kCutOffStep,  // the same, for one action
  kDefined,
  kImpossible,  // a summary that no function can satisfy
  kSomeInitial,
  kSomeValues,
  kSomeEnabled,
  kSomeCondition,
  kSomePromise,
  kNow,
};

/// Says how many instances of quantifiers a question gets; each effort includes the one before. kAll spells
/// out every robot of a team of a fixed size.
enum class Effort : uint8_t { kFew, kMore, kMost, kAll };

/// Holds one question, and its answer once it is asked.
struct Task {
  TaskKind kind;
  size_t subject = 0;  ///< invariant or promise
  size_t action = 0;
  std::string name;  ///< names its file and its line of progress
  solve::Answer answer = solve::Unknown{"not asked"};
  double seconds = 0;
  std::vector<size_t> premises{};  ///< of kFollows: invariants that are proved by induction
  CutOffLimits limits{};           ///< of kCutOff and kCutOffStep

  bool Proved() const { return std::holds_alternative<solve::Unsat>(answer); }
  /// Reports whether the question must be unsatisfiable for the invariants to be proved. Otherwise it is a
  /// sanity check.
  bool IsObligation() const {
    return kind == TaskKind::kInitially || kind == TaskKind::kRound || kind == TaskKind::kStep ||
           kind == TaskKind::kFollows || kind == TaskKind::kDefined || kind == TaskKind::kCutOff ||
           kind == TaskKind::kCutOffStep;
  }
};

/// Returns everything that a proof has to ask, each round as a whole.
std::vector<Task> ListTasks(Problems& problems);
/// Replaces each round that was not proved as a whole by one step for each action; other tasks stay as they
/// are.
std::vector<Task> SplitRounds(std::vector<Task> tasks, Problems& problems);
/// Returns the steps of a round in which robots may be cut off, one for each action.
std::vector<Task> SplitCutOff(const Task& task, Problems& problems);
/// Reports whether a team of this size is small enough to spell out every quantifier over robots (at most
/// 10^5 instances of any).
bool CanExpand(const Model& model, int64_t robots);
/// Returns the actions in the order in which reports show them: events, then `skip`.
std::vector<size_t> Columns(Problems& problems);

/// Returns the question of a task, with as many instances as `effort` says.
Problem StateTask(const Task& task, Problems& problems, Effort effort);

}  // namespace rondo::koord
