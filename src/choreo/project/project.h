#pragma once

#include <map>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "diag/diagnostic.h"

/// Projects choreographies: a local type is what one robot sees of one, as a deterministic automaton
/// (Definition 4.7 of the paper, with the full merge: alternatives that the robot can tell apart by what
/// happens to it are joined).
namespace rondo::choreo {

/// Represents one thing that a robot does: it sends, receives or moves.
struct Action {
  enum class Kind : uint8_t { kSend, kReceive, kMove } kind = Kind::kMove;
  RobotId peer;       ///< of messages
  std::string label;  ///< of the message, or the motion with its arguments
  friend auto operator<=>(const Action&, const Action&) = default;
};

using StateId = base::Id<struct StateTag>;

/// Represents a state of a local type: what the robot may do there.
struct LocalState {
  std::map<Action, StateId> next;
  std::map<Action, std::vector<NodeId>> nodes;  ///< the nodes of the choreography that each action comes from
  /// Gives, if the robot chooses here, the guards and where they lead; an invalid guard: where the ones
  /// before do not hold.
  std::vector<std::pair<ExprId, StateId>> choice;
  NodeId chosen;  ///< the node of that choice
  bool ends = false;
};

/// Represents the local type of one robot.
struct LocalType {
  RobotId robot;
  std::vector<LocalState> states;  ///< the first is where it begins
};

/// Returns the local type of `robot`. Reports where the robot cannot know what to do (`choreo-unmergeable`);
/// then the type must not be used. Cost: exponential at worst in the number of alternatives that look alike
/// to it; linear where it hears of every choice.
LocalType Project(const Graph& graph, const lang::ExprPool& pool, RobotId robot,
                  diag::Diagnostics& diagnostics);

/// Returns an action as text: `send arm.go`, `move Idle()`.
std::string Describe(const Graph& graph, const Action& action);

/// Returns a local type as text, one line for each action: `3: receive arm.done -> 4`.
std::string ToText(const Graph& graph, const lang::ExprPool& pool, const LocalType& type);

}  // namespace rondo::choreo
