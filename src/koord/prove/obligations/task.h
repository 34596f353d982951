#pragma once

#include <string>
#include <vector>

#include "koord/prove/obligations/problem.h"

namespace rondo::koord {

/// The questions that a proof asks (see `Problems` for what each means).
enum class TaskKind : uint8_t {
  kInitially,
  kRound,    // one invariant, any round
  kStep,     // one invariant, the rounds in which one action is the first
  kFollows,  // one invariant, from others at the same moment
  kDefined,
  kImpossible,  // a summary that no function can satisfy
  kSomeInitial,
  kSomeValues,
  kSomeEnabled,
  kSomeCondition,
  kSomePromise,
  kNow,
};

/// How many instances of quantifiers a question gets; each effort includes the one before. kAll: of a team of
/// a fixed number of robots, every robot by itself.
enum class Effort : uint8_t { kFew, kMore, kMost, kAll };

struct Task {
  TaskKind kind;
  size_t subject = 0;  ///< invariant or promise
  size_t action = 0;
  std::string name;  ///< of its file and progress line
  solve::Answer answer = solve::Unknown{"not asked"};
  double seconds = 0;
  std::vector<size_t> premises{};  ///< of kFollows: invariants that are proved by induction

  bool Proved() const { return std::holds_alternative<solve::Unsat>(answer); }
  /// Must it be unsatisfiable for the invariants to be proved? Otherwise it is a sanity check.
  bool IsObligation() const {
    return kind == TaskKind::kInitially || kind == TaskKind::kRound || kind == TaskKind::kStep ||
           kind == TaskKind::kFollows || kind == TaskKind::kDefined;
  }
};

/// Everything that a proof has to ask.
std::vector<Task> ListTasks(Problems& problems);
/// A round that was not proved as a whole becomes one step for each action.
std::vector<Task> SplitRounds(std::vector<Task> tasks, Problems& problems);
/// Is a team of this size small enough to spell out every quantifier over robots (at most 10^5 instances of
/// any)?
bool CanExpand(const Model& model, int64_t robots);
/// The actions in the order in which reports show them: events, then `skip`.
std::vector<size_t> Columns(Problems& problems);

Problem StateTask(const Task& task, Problems& problems, Effort effort);

}  // namespace rondo::koord
