#pragma once

#include <map>
#include <optional>

#include "choreo/process/flow.h"
#include "choreo/process/typing.h"

/// Compares steps of processes with steps of choreographies.
namespace rondo::choreo {

/// Says why a step of a process is not what the choreography says.
struct Wrong {
  diag::Kind kind;
  diag::Span span;
  std::string message;
  std::string help;

  /// Reports it where the process says so, with the place in the choreography.
  void Report(diag::Diagnostics& diagnostics, diag::Span choreography) const;
};

/// Compares values, payloads and motions of one process with those of the choreography (docs/theory.md:
/// Figure 5 and Table 1). What can be decided by simplifying terms is decided; the rest is collected as side
/// conditions.
class Compare {
 public:
  Compare(const Flow& flow, Graph& graph, Declarations& declarations);

  /// Reports whether two labels are the same, for this process.
  bool SameLabel(const std::string& asked, const std::string& given) const;
  /// Returns the guard of a step as a term.
  expr::TermId GuardOf(const FlowNode& node);
  /// Checks an assignment and carries it out: processes assign to names of their own; the state of a robot
  /// changes by its motions only.
  void CheckAssignment(const FlowNode& node);
  /// Returns why what is sent is not what each of the messages carries; nothing if it is.
  std::optional<Wrong> SendPayload(const FlowNode& node, const std::vector<NodeId>& nodes);
  /// Gives the names of a case their meaning: what any of the messages carries. Returns why that does not
  /// fit; nothing if it does.
  std::optional<Wrong> ReceivePayload(const Case& c, const std::vector<NodeId>& nodes);
  /// Returns why the motion of a process, or what it does while it waits, is neither the one of the
  /// choreography nor a refinement; nothing if it is.
  std::optional<Wrong> Moves(const FlowNode& node, const std::vector<NodeId>& nodes);

  /// Returns why a robot does not stand still while it waits, or cannot be interrupted at once; nothing if it
  /// does and can.
  std::optional<Wrong> Stands(const FlowNode& node);

  /// Reports whether `goal` is false wherever `hypothesis` holds, as far as simplification alone shows.
  bool Refuted(expr::TermId hypothesis, expr::TermId goal);
  /// Remembers the side condition that `goal` holds wherever `hypothesis` does, unless that is plainly true.
  void Need(diag::Span span, std::string what, expr::TermId hypothesis, expr::TermId goal,
            std::vector<NodeId> at, bool moving = false);
  /// Returns how many side conditions there are, so that `Forget` can drop those that came later.
  size_t conditions() const { return conditions_.size(); }
  void Forget(size_t from) { conditions_.resize(from); }
  std::vector<SideCondition> TakeConditions() { return std::move(conditions_); }

  /// Reports whether something was taken to be known of a name that does not always hold: what followed has
  /// to be done again.
  bool restarts() const { return restarts_; }
  /// Begins again, with what is known of names now. Returns whether that is necessary. What is known only
  /// ever gets weaker, so that this ends.
  bool Restart();

 private:
  /// Holds what the names of one case stand for, in everything behind it.
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
