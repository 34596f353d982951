#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/id.h"
#include "choreo/syntax/ast.h"
#include "expr/rational.h"
#include "robot/model/world.h"

/// Represents choreographies as graphs, to which both ways of writing them lead.
namespace rondo::choreo {

using RobotId = base::Id<struct RobotTag>;
using NodeId = base::Id<struct NodeTag>;
using Scope = std::set<RobotId>;

/// Holds how long a motion takes: [least, most] seconds, without `most` for ever. An interruptible motion may
/// be ended at any time in between by a message.
struct Duration {
  expr::Rational least;
  std::optional<expr::Rational> most;
  bool interruptible = true;
};

/// Holds a motion of one robot with its arguments. Equal ones are one: compare them by index.
struct Instance {
  RobotId robot;
  const MotionDef* motion = nullptr;
  std::vector<robot::Value> args;  ///< by parameter
  robot::Contract contract;
  std::optional<robot::Control> control;
  Duration duration;
  std::string text;  ///< as it was written first: `Move(1 m)`
};

/// Says what one robot does in a joint motion: an instance of the graph.
struct Part {
  RobotId robot;
  diag::Span span;
  size_t instance = 0;
  Duration duration;
};

/// Holds what is known in one thread of a fork: the space that is its own, what it may assume of the other
/// threads, and what it promises them.
struct ThreadFacts {
  diag::Span span;
  std::optional<expr::TermId> region;  ///< a formula over the point of the world (metres, frame W)
  expr::TermId assume, guarantee;
  std::string region_text{};  ///< as source
};

/// Names what happens at a node.
enum class NodeKind : uint8_t { kMessage, kMotion, kChoice, kMerge, kFork, kJoin, kEnd };

/// Represents one step of a choreography. Which fields are used depends on its kind.
struct Node {
  NodeKind kind = NodeKind::kEnd;
  diag::Span span;
  std::vector<NodeId> next;  ///< kEnd: none; kChoice, kFork: several; else one
  Scope scope;               ///< the robots whose choreography this is
  RobotId from, to;          ///< kMessage
  std::string label;
  std::vector<robot::Value> payload;  ///< kMessage: values, or constants that stand for unknown ones
  std::vector<std::string> names;     ///< of the payload; empty for values
  expr::TermId refinement;            ///< kMessage: what is known of the payload
  expr::TermId when;                  ///< kMessage: its guard
  std::vector<Part> parts;            ///< kMotion: one for each robot in scope
  RobotId chooser;                    ///< kChoice
  std::vector<ExprId> guards;  ///< kChoice, for each of `next`; invalid: where the guards before do not hold
  std::vector<expr::TermId> guard_terms;
  std::vector<Scope> threads;  ///< kFork, for each of `next`
  std::vector<ThreadFacts> facts;
  NodeId join;  ///< kFork
};

/// Represents a choreography, whatever it was written in: messages, joint motions, choices, and threads of
/// robots that do not meet. Refers to the module that it was made from.
struct Graph {
  const ChoreographyDef* source = nullptr;
  std::shared_ptr<const robot::World> world;
  std::vector<Name> robots;  ///< in the order of `world->bodies`: RobotId is the index
  std::vector<Instance> instances;
  expr::TermId initially;
  std::vector<Node> nodes;
  NodeId start;
  bool equal_durations = false;  ///< `option equal_durations`

  const Node& operator[](NodeId id) const { return nodes[id.index()]; }
  Node& operator[](NodeId id) { return nodes[id.index()]; }
  const std::string& NameOf(RobotId id) const { return robots[id.index()].text; }
  const robot::Body& BodyOf(RobotId id) const { return world->bodies[id.index()]; }
  /// Returns the robot of this name; nothing if there is none.
  std::optional<RobotId> Find(std::string_view robot) const;
  /// Returns the names of robots as messages list them: "`a`, `b` and `c`".
  std::string Names(const Scope& scope) const;
};

}  // namespace rondo::choreo
