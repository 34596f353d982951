#pragma once

#include <map>
#include <optional>

#include "choreo/process/flow.h"
#include "choreo/process/typing.h"

namespace rondo::choreo {

/// Why a step of a process is not what the choreography says.
struct Wrong {
  diag::Kind kind;
  diag::Span span;
  std::string message;
  std::string help;

  void Report(diag::Diagnostics& diagnostics, diag::Span choreography) const;
};

/// Compares values, payloads and motions of one process with those of the choreography. What can be decided
/// by simplifying terms is decided; the rest is collected as side conditions.
class Compare {
 public:
  Compare(const Flow& flow, Graph& graph, Declarations& declarations);

  bool SameLabel(const std::string& asked, const std::string& given) const;
  expr::TermId GuardOf(const FlowNode& node);
  /// Processes assign to names of their own; the state of a robot changes by its motions only.
  void CheckAssignment(const FlowNode& node);
  /// Is what is sent what each of the messages carries?
  std::optional<Wrong> SendPayload(const FlowNode& node, const std::vector<NodeId>& nodes);
  /// Gives the names of a case their meaning.
  std::optional<Wrong> ReceivePayload(const Case& c, const std::vector<NodeId>& nodes);
  /// Is the motion of a process, or what it does while it waits, the one of the choreography, or a
  /// refinement?
  std::optional<Wrong> Moves(const FlowNode& node, const std::vector<NodeId>& nodes);

  /// Does a robot that waits stand still, and can it be interrupted at once?
  std::optional<Wrong> Stands(const FlowNode& node);

  /// Is `goal` false wherever `hypothesis` holds, by simplification alone?
  bool Refuted(expr::TermId hypothesis, expr::TermId goal);
  /// Remembers a condition unless it is plainly true.
  void Need(diag::Span span, std::string what, expr::TermId hypothesis, expr::TermId goal,
            std::vector<NodeId> at, bool moving = false);
  size_t conditions() const { return conditions_.size(); }
  void Forget(size_t from) { conditions_.resize(from); }
  std::vector<SideCondition> TakeConditions() { return std::move(conditions_); }

  /// Something was taken to be known of a name that does not always hold: what followed has to be done again.
  bool restarts() const { return restarts_; }
  /// Begins again, with what is known of names now; true if something new is.
  bool Restart();

 private:
  /// What the names of one case stand for, in everything behind it.
  struct Binding {
    std::vector<robot::Value> values;  ///< constants of the choreography, or symbols
    std::vector<expr::TermId> ways;    ///< what is known of the symbols: one of these
    bool constant = false;
    bool used = false;  ///< in this pass
  };

  robot::Scope ScopeOf(const FlowNode& node) const;
  expr::TermId KnownAt(const FlowNode& node) const;
  void NeedKnown(const FlowNode& node, const std::vector<expr::TermId>& terms, diag::Span span);
  expr::TermId WayOf(const Node& message, const std::vector<robot::Value>& values);
  expr::TermId Equal(const robot::Value& a, const robot::Value& b);
  std::optional<Wrong> Refines(const FlowNode& node, const Instance& done, const Instance& asked, NodeId at);

  const Flow& flow_;
  Graph& graph_;
  robot::Evaluator& evaluator_;
  expr::Arena& arena_;
  Calls calls_;
  std::map<const Case*, Binding> bindings_;
  robot::Members locals_;
  std::vector<SideCondition> conditions_;
  bool restarts_ = false;
};

}  // namespace rondo::choreo
