#pragma once

#include <map>

#include "choreo/graph/calls.h"
#include "choreo/node/senses.h"
#include "choreo/process/flow.h"
#include "runtime/sessions/session.h"

namespace rondo::choreo {

/// Does what a process says. Its motions become instances of the graph as they are called.
class ProcessScript final : public runtime::sessions::Program {
 public:
  /// Everything must outlive it.
  ProcessScript(Graph& graph, const Flow& flow, Declarations& declarations, Senses& senses);

  runtime::sessions::Step Next() override;
  bool Waits() const override;
  void Sent() override { at_ = flow_[at_].next; }
  void Took(size_t which, const std::vector<double>& values) override;
  void Moved() override { at_ = flow_[at_].next; }

 private:
  robot::Scope ScopeOf(const FlowNode& node) const;
  std::optional<std::vector<robot::Value>> Values(const std::vector<ExprId>& exprs, const FlowNode& node);
  std::optional<size_t> Motion(const FlowNode& node);
  std::optional<runtime::sessions::Step> Silent(const FlowNode& node);
  std::string LabelOf(RobotId from, RobotId to, const std::string& given) const;

  Graph& graph_;
  const Flow& flow_;
  robot::Evaluator& evaluator_;
  Senses& senses_;
  Calls calls_;
  FlowId at_;
  std::map<const Case*, std::vector<robot::Value>> bindings_;
  robot::Members locals_;
};

}  // namespace rondo::choreo
