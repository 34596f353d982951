#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/id.h"
#include "choreo/syntax/ast.h"
#include "expr/rational.h"

namespace rondo::choreo {

using RobotId = base::Id<struct RobotTag>;
using NodeId = base::Id<struct NodeTag>;
using Scope = std::set<RobotId>;

/// How long a motion takes: [least, most] seconds, without `most` for ever. An interruptible motion may be
/// ended at any time in between by a message.
struct Duration {
  expr::Rational least;
  std::optional<expr::Rational> most;
  bool interruptible = true;
};

/// What one robot does in a joint motion.
struct Part {
  RobotId robot;
  diag::Span span;
  const MotionDef* motion = nullptr;
  const MotionCall* call = nullptr;
  Duration duration;
};

enum class NodeKind : uint8_t { kMessage, kMotion, kChoice, kMerge, kFork, kJoin, kEnd };

struct Node {
  NodeKind kind = NodeKind::kEnd;
  diag::Span span;
  std::vector<NodeId> next;  ///< kEnd: none; kChoice, kFork: several; else one
  Scope scope;               ///< the robots whose choreography this is
  RobotId from, to;          ///< kMessage
  std::string label;
  const Stmt* message = nullptr;
  std::vector<Part> parts;     ///< kMotion: one for each robot in scope
  RobotId chooser;             ///< kChoice
  std::vector<ExprId> guards;  ///< kChoice, for each of `next`; invalid: where the guards before do not hold
  std::vector<Scope> threads;  ///< kFork, for each of `next`
  NodeId join;                 ///< kFork
  const Stmt* threads_of = nullptr;  ///< kFork: as written
};

/// A choreography, whatever it was written in: messages, joint motions, choices, and threads of robots that
/// do not meet. Refers to the module that it was made from.
struct Graph {
  const ChoreographyDef* source = nullptr;
  std::vector<Name> robots;
  std::vector<const RobotDef*> types;  ///< by robot
  std::vector<Node> nodes;
  NodeId start;
  bool equal_durations = false;  ///< `option equal_durations`

  const Node& operator[](NodeId id) const { return nodes[id.index()]; }
  const std::string& NameOf(RobotId id) const { return robots[id.index()].text; }
  /// "`a`, `b` and `c`"
  std::string Names(const Scope& scope) const;
};

}  // namespace rondo::choreo
