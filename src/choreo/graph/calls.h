#pragma once

#include <map>
#include <optional>

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"

/// Resolves calls of motions.
namespace rondo::choreo {

/// Finds the motions that calls mean, and gives them their arguments. Equal calls are one instance of the
/// graph.
class Calls {
 public:
  /// Takes `loose` names, as processes of the original interpreter have them: names of motions may differ in
  /// case and may begin with `m_`.
  Calls(Graph& graph, Declarations& declarations, bool loose = false);

  /// Returns the index of the instance in the graph; nothing after a report. Arguments are evaluated in
  /// `scope`. Motions of one name differ in how many arguments they take.
  std::optional<size_t> Resolve(RobotId robot, const MotionCall& call, const robot::Scope& scope);

 private:
  using Key = std::vector<uint64_t>;

  static Key KeyOf(const Instance& instance);
  const MotionDef* FindMotion(const RobotDef& type, const MotionCall& call);
  bool Named(const MotionDef& motion, const Name& name) const;
  void WrongArguments(const MotionCall& call, const std::vector<const MotionDef*>& candidates);
  std::optional<Duration> DurationOf(const MotionDef& motion, const robot::Scope& names, diag::Span call);
  std::optional<robot::Value> Time(ExprId e, const robot::Scope& names, diag::Span call);
  std::string TextOf(const MotionDef& motion, const MotionCall& call) const;

  Graph& graph_;
  Declarations& declarations_;
  robot::Evaluator& evaluator_;
  bool loose_;
  std::map<Key, size_t> known_;
};

}  // namespace rondo::choreo
