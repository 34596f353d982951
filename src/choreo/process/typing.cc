#include "choreo/process/typing.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "choreo/process/compare.h"
#include "choreo/process/flow.h"
#include "expr/defined.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;
using expr::TermId;

using Transition = std::pair<const Action, StateId>;

/// Follows a process and a local type together, as far as they agree.
class Typing {
 public:
  Typing(const Flow& flow, Graph& graph, const LocalType& type, Declarations& declarations)
      : flow_(flow),
        graph_(graph),
        type_(type),
        diagnostics_(declarations.evaluator().diagnostics()),
        arena_(declarations.evaluator().arena()),
        compare_(flow, graph, declarations) {}

  std::vector<SideCondition> Run() {
    do {
      seen_.clear();
      added_.clear();
      Pair(flow_.start, StateId(0));
      Drain(0);
    } while (compare_.Restart());
    return compare_.TakeConditions();
  }

 private:
  const LocalState& At(StateId s) const { return type_.states[s.index()]; }

  static const Transition* Find(const LocalState& state, Action::Kind kind) {
    const auto it = std::ranges::find_if(state.next, [&](const auto& t) { return t.first.kind == kind; });
    return it == state.next.end() ? nullptr : &*it;
  }

  // While alternatives are tried, nothing is reported.
  bool Fail(const std::function<void()>& report) const {
    if (trying_ == 0) report();
    return false;
  }

  // -- what the choreography asks for

  std::string Asked(StateId s) const {
    const LocalState& state = At(s);
    if (state.ends) return "the choreography ends here";
    if (!state.choice.empty()) return fmt::format("`{}` chooses here", graph_.NameOf(type_.robot));
    std::string text;
    for (const auto& [action, to] : state.next) {
      text += text.empty() ? "" : ", or ";
      switch (action.kind) {
        case Action::Kind::kSend:
          text += fmt::format("`{}` is sent to `{}`", action.label, graph_.NameOf(action.peer));
          break;
        case Action::Kind::kReceive:
          text += fmt::format("`{}` comes from `{}`", action.label, graph_.NameOf(action.peer));
          break;
        case Action::Kind::kMove:
          text += fmt::format("the motion is `{}`", action.label);
          break;
      }
    }
    return "in the choreography, " + text;
  }

  void AtNodes(diag::Diagnostic& report, StateId s) const {
    const LocalState& state = At(s);
    for (const auto& [action, nodes] : state.nodes)
      report.At(graph_[nodes[0]].span, "this is what comes next");
  }

  bool Mismatch(FlowId p, StateId s, std::string_view does) {
    return Fail([&] {
      auto& report = diagnostics_.Report(Kind::kProcessStep, flow_[p].span,
                                         fmt::format("`{}` {} here, which the choreography does not allow",
                                                     graph_.NameOf(type_.robot), does));
      AtNodes(report, s);
      report.Note(Asked(s));
    });
  }

  // -- pairs

  // Each pair is looked at once: what comes back to it is assumed to agree (coinduction).
  bool Pair(FlowId p, StateId s, bool goes_on = false) {
    if (!goes_on && !WaitsWell(p, s)) return false;
    if (!seen_.emplace(p, s).second) return true;
    added_.emplace_back(p, s);
    todo_.emplace_back(p, s);
    return true;
  }

  // Looks at what waits above `base`; stops at the first pair that does not agree.
  bool Drain(size_t base) {
    bool good = true;
    while (todo_.size() > base && good) {
      const auto [p, s] = todo_.back();
      todo_.pop_back();
      good = Visit(p, s) && !compare_.restarts();
    }
    todo_.resize(base);
    return good;
  }

  bool Visit(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    if (node.kind == FlowKind::kAssign) return Assign(p, s);
    if (!At(s).choice.empty()) return Choice(p, s);
    switch (node.kind) {
      case FlowKind::kIf:
        return If(p, s);
      case FlowKind::kSend:
        return Send(p, s);
      case FlowKind::kReceive:
        return Receive(p, s);
      case FlowKind::kMove:
        return Move(p, s);
      case FlowKind::kExit:
        return At(s).ends || Mismatch(p, s, "ends");
      case FlowKind::kAssign:
        break;
    }
    return true;
  }

  bool Assign(FlowId p, StateId s) {
    compare_.CheckAssignment(flow_[p]);
    return Pair(flow_[p].next, s);
  }

  // Both ways have to be as the type says, but for those that are never taken.
  bool If(FlowId p, StateId s) {
    const TermId guard = compare_.GuardOf(flow_[p]);
    if (guard == arena_.True()) return Pair(flow_[p].next, s);
    if (guard == arena_.False()) return Pair(flow_[p].otherwise, s);
    return Pair(flow_[p].next, s) && Pair(flow_[p].otherwise, s);
  }

  // [T-OUT], [Sub-Out]
  bool Send(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    const Transition* send = Find(At(s), Action::Kind::kSend);
    const std::string& label = node.act->label.text;
    if (send == nullptr)
      return Mismatch(p, s, fmt::format("sends `{}` to `{}`", label, graph_.NameOf(node.peer)));
    const auto& [action, to] = *send;
    if (action.peer != node.peer) {
      return Fail([&] {
        auto& report = diagnostics_.Report(Kind::kProcessPeer, node.act->peer.span,
                                           fmt::format("`{}` is for `{}`, not for `{}`", action.label,
                                                       graph_.NameOf(action.peer), graph_.NameOf(node.peer)));
        AtNodes(report, s);
      });
    }
    if (!compare_.SameLabel(action.label, label)) {
      return Fail([&] {
        auto& report = diagnostics_.Report(
            Kind::kProcessLabel, node.act->label.span,
            fmt::format("`{}` expects `{}`, not `{}`", graph_.NameOf(node.peer), action.label, label));
        AtNodes(report, s);
      });
    }
    const std::vector<NodeId>& nodes = At(s).nodes.at(action);
    if (const auto wrong = compare_.SendPayload(node, nodes)) {
      return Fail([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
    }
    return Pair(node.next, to);
  }

  // [T-Choice1], [T-Choice2], [Sub-In1] to [Sub-In3]: a case for each message that may come, and the motion
  // meanwhile.
  bool Receive(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    const LocalState& state = At(s);
    const Transition* move = Find(state, Action::Kind::kMove);
    bool expects = move != nullptr;
    for (const auto& [action, to] : state.next) {
      if (action.kind != Action::Kind::kReceive) continue;
      expects = true;
      if (!Case(p, s, action, to)) return false;
    }
    if (!expects) return Mismatch(p, s, "waits for a message");
    if (move == nullptr) return true;
    if (node.act->motion.motion.text.empty()) {
      return Fail([&] {
        auto& report =
            diagnostics_.Report(Kind::kProcessMotion, node.span,
                                fmt::format("`{}` waits here, but the choreography asks it for `{}`",
                                            graph_.NameOf(type_.robot), move->first.label));
        AtNodes(report, s);
        report.Help(fmt::format("write `receive from ... while {}`", move->first.label));
      });
    }
    if (!Motion(node, s, *move)) return false;
    return Pair(p, move->second, true);
  }

  // Where the choreography has messages and no motion, what a process does while it waits may begin, but
  // nobody moves then: it may only stand. To go on with the motion before is another matter.
  bool WaitsWell(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    if (node.kind != FlowKind::kReceive || node.act->motion.motion.text.empty()) return true;
    if (Find(At(s), Action::Kind::kReceive) == nullptr || Find(At(s), Action::Kind::kMove) != nullptr)
      return true;
    const auto wrong = compare_.Stands(node);
    if (!wrong) return true;
    return Fail([&] { wrong->Report(diagnostics_, graph_[At(s).nodes.begin()->second[0]].span); });
  }

  bool Case(FlowId p, StateId s, const Action& action, StateId to) {
    const FlowNode& node = flow_[p];
    const std::vector<NodeId>& nodes = At(s).nodes.at(action);
    const FlowCase* other = nullptr;
    for (const FlowCase& c : node.cases) {
      if (!compare_.SameLabel(action.label, c.source->label.text)) continue;
      if (c.peer != action.peer) {
        other = &c;
        continue;
      }
      if (const auto wrong = compare_.ReceivePayload(*c.source, nodes)) {
        return Fail([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
      }
      return Pair(c.next, to);
    }
    return Fail([&] {
      if (other != nullptr) {
        diagnostics_
            .Report(Kind::kProcessPeer, other->source->peer.span,
                    fmt::format("`{}` comes from `{}`, not from `{}`", action.label,
                                graph_.NameOf(action.peer), other->source->peer.text))
            .At(graph_[nodes[0]].span, "the message");
        return;
      }
      diagnostics_
          .Report(
              Kind::kProcessCase, node.span,
              fmt::format("there is no case for `{}` from `{}`", action.label, graph_.NameOf(action.peer)))
          .At(graph_[nodes[0]].span, "this message may come");
    });
  }

  // [T-Motion], [Sub-Motion]
  bool Move(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    const LocalState& state = At(s);
    const Transition* move = Find(state, Action::Kind::kMove);
    if (move == nullptr) return Mismatch(p, s, fmt::format("does `{}`", node.act->motion.motion.text));
    for (const auto& [action, to] : state.next) {
      if (action.kind != Action::Kind::kReceive) continue;
      return Fail([&] {
        diagnostics_
            .Report(Kind::kProcessCase, node.span,
                    fmt::format("`{}` from `{}` may come here, and nobody listens", action.label,
                                graph_.NameOf(action.peer)))
            .At(graph_[At(s).nodes.at(action)[0]].span, "this message")
            .Help(fmt::format("write `receive from {} while {}() {{ {} => ... }}`",
                              graph_.NameOf(action.peer), node.act->motion.motion.text, action.label));
      });
    }
    return Motion(node, s, *move) && Pair(node.next, move->second);
  }

  bool Motion(const FlowNode& node, StateId s, const Transition& move) {
    const std::vector<NodeId>& nodes = At(s).nodes.at(move.first);
    const auto wrong = compare_.Moves(node, nodes);
    if (!wrong) return true;
    return Fail([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
  }

  // -- choices

  /// One way through the conditions of a process.
  struct Leaf {
    FlowId at;
    TermId condition;
  };

  // The guards of a process are evaluated in the state in which the robot chooses. What it assigns on the way
  // may change what they mean, so they prove nothing of the guards of the choreography then.
  std::vector<Leaf> Leaves(FlowId start) {
    // The conditions have no loops: each node comes before those behind it.
    std::vector<FlowId> order;
    std::set<FlowId> seen;
    std::vector<std::pair<FlowId, bool>> todo{{start, false}};
    while (!todo.empty()) {
      const auto [id, behind] = todo.back();
      todo.pop_back();
      if (behind) {
        order.push_back(id);
        continue;
      }
      if (!seen.insert(id).second) continue;
      todo.emplace_back(id, true);
      const FlowNode& node = flow_[id];
      if (node.kind == FlowKind::kIf) todo.emplace_back(node.otherwise, false);
      if (node.kind == FlowKind::kIf || node.kind == FlowKind::kAssign) todo.emplace_back(node.next, false);
    }
    std::map<FlowId, std::vector<TermId>> conditions{{start, {arena_.True()}}};
    std::vector<Leaf> leaves;
    for (size_t i = order.size(); i-- > 0;) {
      const FlowNode& node = flow_[order[i]];
      const TermId condition = arena_.Or(conditions[order[i]]);
      if (condition == arena_.False()) continue;
      if (node.kind == FlowKind::kAssign) {
        compare_.CheckAssignment(node);
        conditions[node.next].push_back(arena_.True());
      } else if (node.kind == FlowKind::kIf) {
        const TermId guard = compare_.GuardOf(node);
        conditions[node.next].push_back(arena_.And(condition, guard));
        conditions[node.otherwise].push_back(arena_.And(condition, expr::Complement(arena_, guard)));
      } else {
        leaves.push_back({order[i], condition});
      }
    }
    return leaves;
  }

  // Does the alternative begin as the process does? Necessary, not sufficient.
  bool Begins(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    const LocalState& state = At(s);
    if (!state.choice.empty()) return true;
    switch (node.kind) {
      case FlowKind::kSend: {
        const Transition* send = Find(state, Action::Kind::kSend);
        return send != nullptr && send->first.peer == node.peer &&
               compare_.SameLabel(send->first.label, node.act->label.text);
      }
      case FlowKind::kReceive:
        return Find(state, Action::Kind::kReceive) != nullptr || Find(state, Action::Kind::kMove) != nullptr;
      case FlowKind::kMove:
        return Find(state, Action::Kind::kMove) != nullptr;
      case FlowKind::kExit:
        return state.ends;
      case FlowKind::kIf:
      case FlowKind::kAssign:
        break;
    }
    return true;
  }

  // Keeps what is assumed of an alternative only if it fits.
  bool Try(FlowId p, StateId s) {
    const size_t mark = added_.size();
    const size_t base = todo_.size();
    const size_t conditions = compare_.conditions();
    ++trying_;
    const bool good = Pair(p, s) && Drain(base);
    --trying_;
    if (good) return true;
    while (added_.size() > mark) {
      seen_.erase(added_.back());
      added_.pop_back();
    }
    compare_.Forget(conditions);
    return false;
  }

  // [T-Cond]: on each way through the conditions, some alternative is allowed and is what the process does.
  bool Choice(FlowId p, StateId s) {
    const auto& choice = At(s).choice;
    for (const Leaf& leaf : Leaves(p)) {
      std::vector<size_t> candidates;
      for (size_t b = 0; b < choice.size(); ++b) {
        if (Begins(leaf.at, choice[b].second)) candidates.push_back(b);
      }
      if (candidates.empty()) return NoAlternative(leaf, s);
      // One that begins so must fit; of several, some.
      std::vector<TermId> guards;
      for (const size_t b : candidates) {
        const StateId to = choice[b].second;
        if (compare_.restarts()) return false;
        if (candidates.size() == 1 ? Pair(leaf.at, to) : Try(leaf.at, to)) guards.push_back(GuardTerm(s, b));
      }
      if (compare_.restarts()) return false;
      if (guards.empty()) return NoAlternative(leaf, s);
      if (!Offered(p, leaf, s, arena_.Or(guards))) return false;
    }
    return true;
  }

  bool Offered(FlowId p, const Leaf& leaf, StateId s, TermId goal) {
    const Span span = flow_[leaf.at].span;
    if (compare_.Refuted(leaf.condition, goal)) {
      return Fail([&] {
        diagnostics_.Report(Kind::kProcessGuard, span, "the choreography never offers this alternative here")
            .At(flow_[p].span, "the process chooses here")
            .At(graph_[At(s).chosen].span, "the choice in the choreography");
      });
    }
    compare_.Need(span, "whether the choreography offers this alternative", leaf.condition, goal,
                  {At(s).chosen});
    return true;
  }

  TermId GuardTerm(StateId s, size_t branch) const { return graph_[At(s).chosen].guard_terms[branch]; }

  bool NoAlternative(const Leaf& leaf, StateId s) {
    return Fail([&] {
      auto& report = diagnostics_.Report(Kind::kProcessGuard, flow_[leaf.at].span,
                                         "no alternative of the choreography goes on like this");
      report.At(graph_[At(s).chosen].span, "the choice");
      for (const auto& [guard, to] : At(s).choice) report.Note(Asked(to));
    });
  }

  const Flow& flow_;
  Graph& graph_;
  const LocalType& type_;
  diag::Diagnostics& diagnostics_;
  expr::Arena& arena_;
  Compare compare_;
  std::set<std::pair<FlowId, StateId>> seen_;
  std::vector<std::pair<FlowId, StateId>> added_;
  std::vector<std::pair<FlowId, StateId>> todo_;
  int trying_ = 0;
};

}  // namespace

std::vector<SideCondition> TypeProcess(const Flow& flow, Graph& graph, const LocalType& type,
                                       Declarations& declarations) {
  return Typing(flow, graph, type, declarations).Run();
}

}  // namespace rondo::choreo
