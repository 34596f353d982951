#include "choreo/graph/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "choreo/graph/equations.h"
#include "choreo/graph/node_builder.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;

/// From statements to nodes.
class Lowering : public NodeBuilder {
 public:
  using NodeBuilder::NodeBuilder;

  std::optional<Graph> Run(const ChoreographyDef& source) {
    const auto everybody = Begin(source);
    if (!everybody) return std::nullopt;
    const NodeId end = Add(Make(NodeKind::kEnd, source.span, *everybody));
    graph_.start = Statements(source.body, end, *everybody);
    return Finish();
  }

 private:
  NodeId AddMerge(Span span, const Scope& scope) { return Add(Make(NodeKind::kMerge, span, scope)); }

  // From the last statement to the first: each knows where it goes on.
  NodeId Statements(const std::vector<Stmt>& body, NodeId next, const Scope& scope) {
    for (size_t i = body.size(); i-- > 0;) {
      const bool ends = body[i].kind == StmtKind::kLoop || body[i].kind == StmtKind::kContinue;
      if (ends && i + 1 < body.size()) {
        diagnostics_.Report(Kind::kChoreoUnreachable, body[i + 1].span, "this step is never reached")
            .At(body[i].span, "what stands here never goes on");
      }
      next = Statement(body[i], next, scope);
    }
    return next;
  }

  NodeId Statement(const Stmt& s, NodeId next, const Scope& scope) {
    switch (s.kind) {
      case StmtKind::kMessage:
        return Message(s, next, scope);
      case StmtKind::kMotion:
        return Motion(s, next, scope);
      case StmtKind::kParallel:
        return Parallel(s, next, scope);
      case StmtKind::kChoose:
        return Choose(s, next, scope);
      case StmtKind::kLoop: {
        const NodeId head = AddMerge(s.span, scope);
        SetNext(head, Statements(s.body, head, scope));
        return head;
      }
      case StmtKind::kWhile:
        return While(s, next, scope);
      case StmtKind::kRec:
        return Recursion(s, next, scope);
      case StmtKind::kContinue:
        return Continue(s);
    }
    return next;
  }

  void SetNext(NodeId node, NodeId next) { graph_.nodes[node.index()].next = {next}; }

  NodeId Message(const Stmt& s, NodeId next, const Scope& scope) {
    Node node = MakeMessage(s, scope);
    node.next = {next};
    return Add(std::move(node));
  }

  NodeId Motion(const Stmt& s, NodeId next, const Scope& scope) {
    Node node = MakeMotion(s, scope);
    node.next = {next};
    return Add(std::move(node));
  }

  void Mentioned(const std::vector<Stmt>& body, ThreadRobots& thread) const {
    for (const Stmt& s : body) {
      Mentions(s, thread);
      Mentioned(s.body, thread);
      for (const Branch& b : s.branches) Mentioned(b.body, thread);
    }
  }

  NodeId Parallel(const Stmt& s, NodeId next, const Scope& scope) {
    Node join = Make(NodeKind::kJoin, s.span, scope);
    join.next = {next};
    std::vector<ThreadRobots> threads(s.branches.size());
    for (size_t b = 0; b < s.branches.size(); ++b) Mentioned(s.branches[b].body, threads[b]);
    Node fork = MakeFork(s, threads, scope);
    fork.join = Add(std::move(join));
    // A recursion around the threads cannot go on from inside one of them.
    auto outer = std::exchange(recursions_, {});
    for (auto& [name, head] : outer) recursions_.emplace(name, NodeId());
    for (size_t b = 0; b < s.branches.size(); ++b)
      fork.next.push_back(Statements(s.branches[b].body, fork.join, fork.threads[b]));
    recursions_ = std::move(outer);
    return Add(std::move(fork));
  }

  NodeId Choose(const Stmt& s, NodeId next, const Scope& scope) {
    Node choice = Make(NodeKind::kChoice, s.span, scope);
    choice.chooser = Robot(s.chooser, scope);
    const NodeId merge = AddMerge(s.span, scope);
    SetNext(merge, next);
    for (const Branch& b : s.branches) {
      AddGuard(b.guard, choice);
      choice.next.push_back(Statements(b.body, merge, scope));
    }
    return Add(std::move(choice));
  }

  NodeId While(const Stmt& s, NodeId next, const Scope& scope) {
    const NodeId head = AddMerge(s.span, scope);
    Node choice = Make(NodeKind::kChoice, s.span, scope);
    const std::map<RobotId, Span> owners = Owners(s.guard);
    if (owners.empty()) {
      diagnostics_
          .Report(Kind::kChoreoGuardOwner, pool_[s.guard].span, "this guard reads the state of no robot")
          .Note("the robot whose state a guard reads decides whether the loop goes on");
    } else {
      choice.chooser = owners.begin()->first;
      if (!scope.contains(choice.chooser))
        Robot(Name{graph_.NameOf(choice.chooser), owners.begin()->second}, scope);
    }
    AddGuard(s.guard, choice);
    AddGuard({}, choice);
    choice.next = {Statements(s.body, head, scope), next};
    SetNext(head, Add(std::move(choice)));
    return head;
  }

  NodeId Recursion(const Stmt& s, NodeId next, const Scope& scope) {
    const NodeId head = AddMerge(s.span, scope);
    const auto before = recursions_.find(s.label.text);
    const std::optional<NodeId> hidden =
        before == recursions_.end() ? std::nullopt : std::optional(before->second);
    recursions_[s.label.text] = head;
    SetNext(head, Statements(s.body, next, scope));
    recursions_.erase(s.label.text);
    if (hidden) recursions_[s.label.text] = *hidden;
    return head;
  }

  NodeId Continue(const Stmt& s) {
    const auto it = recursions_.find(s.label.text);
    if (it != recursions_.end() && it->second.valid()) return it->second;
    if (it != recursions_.end()) {
      diagnostics_
          .Report(Kind::kChoreoOutOfScope, s.span,
                  fmt::format("the recursion `{}` is outside this `parallel`", s.label.text))
          .Help("let the threads join, and go on behind the `parallel`");
    } else {
      std::vector<std::string> names;
      for (const auto& [name, head] : recursions_) names.push_back(name);
      declarations_.Undeclared(s.label, "recursion", names);
    }
    return graph_.nodes.empty() ? NodeId() : NodeId(0);
  }

  std::map<std::string, NodeId, std::less<>> recursions_;  // invalid: outside the threads that are lowered
};

}  // namespace

std::vector<Graph> Lower(const Module& module, Declarations& declarations) {
  std::vector<Graph> graphs;
  for (const Item& item : module.items) {
    const auto* choreography = std::get_if<ChoreographyDef>(&item);
    if (choreography == nullptr) continue;
    auto graph = choreography->equations.empty() ? Lowering(declarations).Run(*choreography)
                                                 : LowerEquations(*choreography, declarations);
    if (graph) graphs.push_back(std::move(*graph));
  }
  return graphs;
}

}  // namespace rondo::choreo
