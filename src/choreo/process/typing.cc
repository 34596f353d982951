#include "choreo/process/typing.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "choreo/process/compare.h"
#include "choreo/process/flow.h"
#include "choreo/process/mismatch.h"
#include "choreo/process/ways.h"

namespace rondo::choreo {
namespace {

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
        compare_(flow, graph, declarations),
        mismatch_(flow, graph, type, diagnostics_) {}

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
        return At(s).ends || mismatch_.Step(p, s, "ends");
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
      return mismatch_.Step(p, s, fmt::format("sends `{}` to `{}`", label, graph_.NameOf(node.peer)));
    const auto& [action, to] = *send;
    if (action.peer != node.peer) return mismatch_.Peer(p, s, action);
    if (!compare_.SameLabel(action.label, label)) return mismatch_.Label(p, s, action);
    const std::vector<NodeId>& nodes = At(s).nodes.at(action);
    if (const auto wrong = compare_.SendPayload(node, nodes)) {
      return mismatch_.Report([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
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
    if (!expects) return mismatch_.Step(p, s, "waits for a message");
    if (move == nullptr) return true;
    if (node.act->motion.motion.text.empty()) return mismatch_.Waits(p, s, move->first);
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
    return mismatch_.Report(
        [&] { wrong->Report(diagnostics_, graph_[At(s).nodes.begin()->second[0]].span); });
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
        return mismatch_.Report([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
      }
      return Pair(c.next, to);
    }
    return mismatch_.NoCase(p, s, action, other);
  }

  // [T-Motion], [Sub-Motion]
  bool Move(FlowId p, StateId s) {
    const FlowNode& node = flow_[p];
    const LocalState& state = At(s);
    const Transition* move = Find(state, Action::Kind::kMove);
    if (move == nullptr) return mismatch_.Step(p, s, fmt::format("does `{}`", node.act->motion.motion.text));
    for (const auto& [action, to] : state.next) {
      if (action.kind == Action::Kind::kReceive) return mismatch_.NobodyListens(p, s, action);
    }
    return Motion(node, s, *move) && Pair(node.next, move->second);
  }

  bool Motion(const FlowNode& node, StateId s, const Transition& move) {
    const std::vector<NodeId>& nodes = At(s).nodes.at(move.first);
    const auto wrong = compare_.Moves(node, nodes);
    if (!wrong) return true;
    return mismatch_.Report([&] { wrong->Report(diagnostics_, graph_[nodes[0]].span); });
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
    ++mismatch_.trying;
    const bool good = Pair(p, s) && Drain(base);
    --mismatch_.trying;
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
    for (const Way& way : WaysThrough(flow_, p, compare_, arena_)) {
      std::vector<size_t> candidates;
      for (size_t b = 0; b < choice.size(); ++b) {
        if (Begins(way.to, choice[b].second)) candidates.push_back(b);
      }
      if (candidates.empty()) return mismatch_.NoAlternative(way.to, s);
      // One that begins so must fit; of several, some.
      std::vector<TermId> guards;
      for (const size_t b : candidates) {
        const StateId to = choice[b].second;
        if (compare_.restarts()) return false;
        if (candidates.size() == 1 ? Pair(way.to, to) : Try(way.to, to)) guards.push_back(GuardTerm(s, b));
      }
      if (compare_.restarts()) return false;
      if (guards.empty()) return mismatch_.NoAlternative(way.to, s);
      if (!Offered(p, way, s, arena_.Or(guards))) return false;
    }
    return true;
  }

  bool Offered(FlowId p, const Way& way, StateId s, TermId goal) {
    if (compare_.Refuted(way.condition, goal)) return mismatch_.NeverOffered(p, way.to, s);
    compare_.Need(flow_[way.to].span, "whether the choreography offers this alternative", way.condition, goal,
                  {At(s).chosen});
    return true;
  }

  TermId GuardTerm(StateId s, size_t branch) const { return graph_[At(s).chosen].guard_terms[branch]; }

  const Flow& flow_;
  Graph& graph_;
  const LocalType& type_;
  diag::Diagnostics& diagnostics_;
  expr::Arena& arena_;
  Compare compare_;
  Mismatch mismatch_;
  std::set<std::pair<FlowId, StateId>> seen_;
  std::vector<std::pair<FlowId, StateId>> added_;
  std::vector<std::pair<FlowId, StateId>> todo_;
};

}  // namespace

std::vector<SideCondition> TypeProcess(const Flow& flow, Graph& graph, const LocalType& type,
                                       Declarations& declarations) {
  return Typing(flow, graph, type, declarations).Run();
}

}  // namespace rondo::choreo
