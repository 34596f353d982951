#include "choreo/graph/equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "choreo/graph/node_builder.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;

NodeKind KindOf(EquationKind kind) {
  switch (kind) {
    case EquationKind::kMessage:
      return NodeKind::kMessage;
    case EquationKind::kMotion:
      return NodeKind::kMotion;
    case EquationKind::kChoice:
      return NodeKind::kChoice;
    case EquationKind::kMerge:
      return NodeKind::kMerge;
    case EquationKind::kFork:
      return NodeKind::kFork;
    case EquationKind::kJoin:
      return NodeKind::kJoin;
    case EquationKind::kEnd:
      return NodeKind::kEnd;
  }
  return NodeKind::kEnd;
}

class EquationLowering : public NodeBuilder {
 public:
  EquationLowering(const ChoreographyDef& source, Declarations& declarations)
      : NodeBuilder(declarations), source_(source), equations_(source.equations) {}

  std::optional<Graph> Run() {
    const auto everybody = Begin(source_);
    if (!everybody) return std::nullopt;
    const size_t errors = diagnostics_.errors();
    Connect();
    if (diagnostics_.errors() > errors) return std::nullopt;
    joins_.resize(equations_.size());
    for (size_t e = 0; e < equations_.size(); ++e) {
      if (equations_[e].kind == EquationKind::kFork) FindJoin(e);
    }
    if (diagnostics_.errors() > errors) return std::nullopt;
    graph_.nodes.resize(equations_.size());
    graph_.start = NodeId(next_of_.at(source_.first.text));
    Fill(graph_.start.index(), *everybody, {});
    for (size_t e = 0; e < equations_.size(); ++e) {
      if (!filled_.contains(e))
        diagnostics_.Report(Kind::kChoreoUnreachable, equations_[e].span, "this step is never reached");
    }
    return Finish();
  }

 private:
  // Who goes on in a state, and who leads there.
  void Connect() {
    std::map<std::string, Span, std::less<>> left, right;
    bool ended = false;
    const auto once = [&](auto& side, const Name& name, std::string_view what) {
      const auto [it, fresh] = side.emplace(name.text, name.span);
      if (fresh) return;
      diagnostics_
          .Report(Kind::kChoreoEquation, name.span, fmt::format("the state `{}` {} twice", name.text, what))
          .At(it->second, "first here");
    };
    for (size_t e = 0; e < equations_.size(); ++e) {
      for (const Name& name : equations_[e].from) {
        once(left, name, "goes on");
        next_of_.emplace(name.text, e);
      }
      for (const Name& name : equations_[e].to) once(right, name, "is reached");
      if (equations_[e].kind != EquationKind::kEnd) continue;
      if (ended) diagnostics_.Report(Kind::kChoreoEquation, equations_[e].span, "a choreography ends once");
      ended = true;
    }
    for (const auto& [name, span] : right) {
      if (!left.contains(name))
        diagnostics_.Report(Kind::kChoreoEquation, span, fmt::format("nothing says how `{}` goes on", name));
    }
    for (const auto& [name, span] : left) {
      if (!right.contains(name) && name != source_.first.text)
        diagnostics_.Report(Kind::kChoreoEquation, span, fmt::format("nothing leads to `{}`", name));
    }
    if (!left.contains(source_.first.text)) {
      diagnostics_.Report(Kind::kChoreoEquation, source_.first.span,
                          fmt::format("nothing says how `{}` goes on", source_.first.text));
    } else if (right.contains(source_.first.text)) {
      diagnostics_
          .Report(Kind::kChoreoEquation, source_.first.span,
                  fmt::format("`{}`, where it begins, is reached again", source_.first.text))
          .Help("let the loop go back to a merge behind the beginning");
    }
  }

  std::vector<size_t> Next(size_t e) const {
    std::vector<size_t> next;
    for (const Name& name : equations_[e].to) next.push_back(next_of_.at(name.text));
    return next;
  }

  struct Place {
    std::string state;  // that goes on there
    size_t equation;
    size_t depth;  // how many forks lie between
  };

  // The join of a fork, to which all ways from all its threads lead; and who is mentioned on them.
  void FindJoin(size_t fork) {
    std::optional<size_t>& join = joins_[fork];
    threads_[fork].resize(equations_[fork].to.size());
    const std::vector<size_t> starts = Next(fork);
    std::set<std::string> arrived;  // each thread arrives by a state of its own
    for (size_t b = 0; b < starts.size(); ++b) {
      std::map<size_t, size_t> seen;
      std::set<std::string> own;
      std::vector<Place> todo{{equations_[fork].to[b].text, starts[b], 0}};
      while (!todo.empty()) {
        const Place at = todo.back();
        todo.pop_back();
        const Equation& e = equations_[at.equation];
        if (e.kind == EquationKind::kJoin && at.depth == 0) {
          if (join && *join != at.equation) return Torn(fork, e.span);
          join = at.equation;
          own.insert(at.state);
          continue;
        }
        const auto [it, fresh] = seen.emplace(at.equation, at.depth);
        if (!fresh && it->second != at.depth) return Torn(fork, e.span);
        if (!fresh) continue;
        if (e.kind == EquationKind::kEnd || at.equation == fork) return Torn(fork, e.span);
        Mentions(e.step, threads_[fork][b]);
        const size_t depth = at.depth + (e.kind == EquationKind::kFork) - (e.kind == EquationKind::kJoin);
        for (const Name& next : e.to) todo.push_back({next.text, next_of_.at(next.text), depth});
      }
      if (own.size() > 1) return Torn(fork, equations_[*join].span);
      arrived.merge(own);
    }
    if (!join) return;  // threads that go round for ever
    if (equations_[*join].from.size() != arrived.size()) Torn(fork, equations_[*join].span);
  }

  void Torn(size_t fork, Span span) {
    diagnostics_
        .Report(Kind::kChoreoEquation, equations_[fork].span,
                "the threads of this fork do not join in one place")
        .At(span, "a way from it leads here");
  }

  void Fill(size_t start, const Scope& scope, const std::vector<size_t>& forks) {
    struct Work {
      size_t equation;
      Scope scope;
      std::vector<size_t> forks;  // that we are in
    };
    std::vector<Work> todo{{start, scope, forks}};
    while (!todo.empty()) {
      Work work = std::move(todo.back());
      todo.pop_back();
      if (!filled_.insert(work.equation).second) continue;
      const Equation& e = equations_[work.equation];
      if (e.kind == EquationKind::kJoin) {
        if (work.forks.empty()) {
          diagnostics_.Report(Kind::kChoreoEquation, e.span, "nothing was forked that could join here");
          continue;
        }
        work.scope = graph_.nodes[work.forks.back()].scope;
        work.forks.pop_back();
      }
      Node node = MakeNode(work.equation, work.scope);
      const std::vector<size_t> next = Next(work.equation);
      for (const size_t n : next) node.next.emplace_back(n);
      for (size_t b = 0; b < next.size(); ++b) {
        Work following{next[b], node.kind == NodeKind::kFork ? node.threads[b] : work.scope, work.forks};
        if (node.kind == NodeKind::kFork) following.forks.push_back(work.equation);
        todo.push_back(std::move(following));
      }
      graph_.nodes[work.equation] = std::move(node);
    }
  }

  Node MakeNode(size_t index, const Scope& scope) {
    const Equation& e = equations_[index];
    switch (e.kind) {
      case EquationKind::kMessage:
        return MakeMessage(e.step, scope);
      case EquationKind::kMotion:
        return MakeMotion(e.step, scope);
      case EquationKind::kFork: {
        Node fork = MakeFork(e.step, threads_[index], scope);
        if (joins_[index]) {
          fork.join = NodeId(*joins_[index]);
        } else {
          // Its threads never end: a join that nobody reaches.
          fork.join = Add(Make(NodeKind::kJoin, e.span, scope));
          graph_.nodes.back().next = {Add(Make(NodeKind::kEnd, e.span, scope))};
        }
        return fork;
      }
      case EquationKind::kChoice:
        return MakeChoice(e, scope);
      case EquationKind::kMerge:
      case EquationKind::kJoin:
      case EquationKind::kEnd:
        break;
    }
    return Make(KindOf(e.kind), e.span, scope);
  }

  // Whose state the guards read decides.
  Node MakeChoice(const Equation& e, const Scope& scope) {
    Node choice = Make(NodeKind::kChoice, e.span, scope);
    for (const Branch& b : e.step.branches) {
      for (const auto& [robot, span] : Owners(b.guard)) {
        if (choice.chooser.valid()) continue;
        choice.chooser = robot;
        if (!scope.contains(robot)) Robot({graph_.NameOf(robot), span}, scope);
      }
    }
    if (!choice.chooser.valid()) {
      diagnostics_.Report(Kind::kChoreoGuardOwner, e.span, "these guards read the state of no robot")
          .Note("the robot whose state the guards read decides");
    }
    for (const Branch& b : e.step.branches) AddGuard(b.guard, choice);
    return choice;
  }

  const ChoreographyDef& source_;
  const std::vector<Equation>& equations_;
  std::map<std::string, size_t, std::less<>> next_of_;   // the equation with a state to its left
  std::map<size_t, std::vector<ThreadRobots>> threads_;  // by fork
  std::vector<std::optional<size_t>> joins_;             // by fork
  std::set<size_t> filled_;
};

}  // namespace

std::optional<Graph> LowerEquations(const ChoreographyDef& source, Declarations& declarations) {
  return EquationLowering(source, declarations).Run();
}

}  // namespace rondo::choreo
