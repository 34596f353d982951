#include "choreo/project/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lang/expr_printer.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using Set = std::set<NodeId>;

/// The subset construction over what concerns one robot.
class Projection {
 public:
  Projection(const Graph& graph, const lang::ExprPool& pool, RobotId robot, diag::Diagnostics& diagnostics)
      : graph_(graph), pool_(pool), robot_(robot), diagnostics_(diagnostics) {
    type_.robot = robot;
  }

  LocalType Run() {
    StateOf(Closure({graph_.start}), {});
    for (size_t s = 0; s < sets_.size(); ++s) Expand(s);
    for (size_t s = 0; s < sets_.size(); ++s) CompareWithLater(s);
    return std::move(type_);
  }

 private:
  bool Chooses(const Node& n) const { return n.kind == NodeKind::kChoice && n.chooser == robot_; }

  // Does something happen to the robot at this node?
  bool Concerns(const Node& n) const {
    switch (n.kind) {
      case NodeKind::kMessage:
        return n.from == robot_ || n.to == robot_;
      case NodeKind::kMotion:
        return n.scope.contains(robot_);
      case NodeKind::kChoice:
        return Chooses(n);
      case NodeKind::kEnd:
        return true;
      case NodeKind::kMerge:
      case NodeKind::kFork:
      case NodeKind::kJoin:
        return false;
    }
    return false;
  }

  // The nodes that concern the robot and may come next.
  Set Closure(std::vector<NodeId> todo) const {
    Set seen, result;
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (!seen.insert(id).second) continue;
      const Node& n = graph_[id];
      if (Concerns(n)) {
        result.insert(id);
        continue;
      }
      for (size_t b = 0; b < n.next.size(); ++b) {
        if (n.kind != NodeKind::kFork || n.threads[b].contains(robot_)) todo.push_back(n.next[b]);
      }
    }
    return result;
  }

  // How a state was first reached: from which other one, and by what, if by anything.
  struct Way {
    size_t from = 0;
    std::optional<Action> action;
  };

  StateId StateOf(Set set, Way way) {
    const auto [it, fresh] = states_.emplace(set, StateId(sets_.size()));
    if (fresh) {
      sets_.push_back(std::move(set));
      ways_.push_back(std::move(way));
      type_.states.emplace_back();
    }
    return it->second;
  }

  Action ActionOf(const Node& n) const {
    if (n.kind == NodeKind::kMessage) {
      const bool sends = n.from == robot_;
      return {sends ? Action::Kind::kSend : Action::Kind::kReceive, sends ? n.to : n.from, n.label};
    }
    for (const Part& p : n.parts) {
      if (p.robot == robot_) return {Action::Kind::kMove, {}, graph_.instances[p.instance].text};
    }
    return {};
  }

  void Expand(size_t s) {
    const Set set = sets_[s];
    std::map<Action, std::vector<NodeId>> targets;
    std::map<Action, NodeId> origins;
    NodeId choice, end;
    for (const NodeId id : set) {
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kEnd) {
        end = id;
      } else if (n.kind == NodeKind::kChoice) {
        if (choice.valid()) Unclear(s, choice, id);
        choice = id;
      } else {
        const Action a = ActionOf(n);
        targets[a].push_back(n.next[0]);
        type_.states[s].nodes[a].push_back(id);
        origins.emplace(a, id);
      }
    }
    type_.states[s].ends = end.valid();
    origins_.push_back(origins);
    Compare(s, origins, choice, end);
    for (auto& [action, nodes] : targets) {
      const StateId to = StateOf(Closure(std::move(nodes)), {s, action});
      type_.states[s].next.emplace(action, to);
    }
    if (!choice.valid()) return;
    type_.states[s].chosen = choice;
    const Node& n = graph_[choice];
    for (size_t b = 0; b < n.next.size(); ++b) {
      const StateId to = StateOf(Closure({n.next[b]}), {s, std::nullopt});
      type_.states[s].choice.emplace_back(n.guards[b], to);
    }
  }

  // What the robot does of itself must be the only thing that may come next; what happens to it may be one of
  // several messages, and waiting for them one motion.
  void Compare(size_t s, const std::map<Action, NodeId>& origins, NodeId choice, NodeId end) {
    NodeId own = choice;
    for (const auto& [action, id] : origins) {
      if (action.kind != Action::Kind::kSend && action.kind != Action::Kind::kMove) continue;
      if (own.valid()) return Unclear(s, own, id);
      own = id;
    }
    if (end.valid() && own.valid()) return Unclear(s, own, end);
    const bool sends = own.valid() && (own == choice || graph_[own].kind == NodeKind::kMessage || Holds(own));
    NodeId other;
    for (const auto& [action, id] : origins) {
      if (action.kind != Action::Kind::kReceive) continue;
      if (sends) return Unclear(s, own, id);
      if (end.valid()) return Unclear(s, id, end);
      // Of two senders, one may be early: it does not know that the robot should hear the other one first.
      if (other.valid() && graph_[other].from != action.peer) return Unclear(s, other, id);
      other = id;
    }
  }

  // A motion in which the robot could not listen from its beginning.
  bool Holds(NodeId motion) const {
    return std::ranges::any_of(graph_[motion].parts, [&](const Part& p) {
      return p.robot == robot_ && (!p.duration.interruptible || !p.duration.least.IsZero());
    });
  }

  // A motion may be short. So a message that may come before it must not be one that may also come right
  // behind it with another meaning, nor compete with one of another sender, or with what the robot says
  // itself.
  void CompareWithLater(size_t s) {
    std::set<size_t> seen{s};
    for (size_t t = s; true;) {
      const auto& next = type_.states[t].next;
      const auto move =
          std::ranges::find_if(next, [](const auto& a) { return a.first.kind == Action::Kind::kMove; });
      if (move == next.end()) return;
      t = move->second.index();
      if (!seen.insert(t).second) return;
      for (const auto& [action, to] : type_.states[s].next) {
        if (action.kind != Action::Kind::kReceive) continue;
        const auto later = type_.states[t].next.find(action);
        if (later != type_.states[t].next.end() && later->second != to)
          return Unclear(s, origins_[s].at(action), origins_[t].at(action));
        // Nor who of two senders is early, nor whether to wait on or to speak.
        if (type_.states[t].chosen.valid()) return Unclear(s, origins_[s].at(action), type_.states[t].chosen);
        for (const auto& [other, behind] : type_.states[t].next) {
          if (other.kind == Action::Kind::kSend ||
              (other.kind == Action::Kind::kReceive && other.peer != action.peer))
            return Unclear(s, origins_[s].at(action), origins_[t].at(other));
        }
      }
    }
  }

  void Unclear(size_t s, NodeId a, NodeId b) {
    auto& report =
        diagnostics_.Report(Kind::kChoreoUnmergeable, graph_[a].span,
                            fmt::format("`{}` cannot know whether this comes next", graph_.NameOf(robot_)));
    if (graph_[b].kind == NodeKind::kEnd) {
      report.Note("or whether the choreography has ended");
    } else {
      report.At(graph_[b].span, "or this, depending on a choice that it is not told of");
    }
    const std::string history = History(s);
    report
        .Note(history.empty() ? "nothing has happened to it so far"
                              : fmt::format("all that it has seen by then: {}", history))
        .Help("send it a message in each alternative");
  }

  // A shortest run to a state, as the robot sees it; of a long one, the end.
  std::string History(size_t s) const {
    constexpr int kMostSteps = 8;
    std::string text;
    for (int steps = 0; s != 0; s = ways_[s].from) {
      if (!ways_[s].action) continue;
      if (++steps > kMostSteps) return "..., " + text;
      text = fmt::format("{}{}{}", Describe(graph_, *ways_[s].action), text.empty() ? "" : ", ", text);
    }
    return text;
  }

  const Graph& graph_;
  const lang::ExprPool& pool_;
  RobotId robot_;
  diag::Diagnostics& diagnostics_;
  LocalType type_;
  std::map<Set, StateId> states_;
  std::vector<Set> sets_;
  std::vector<Way> ways_;
  std::vector<std::map<Action, NodeId>> origins_;  // by state
};

}  // namespace

std::string Describe(const Graph& graph, const Action& a) {
  switch (a.kind) {
    case Action::Kind::kSend:
      return fmt::format("send {}.{}", graph.NameOf(a.peer), a.label);
    case Action::Kind::kReceive:
      return fmt::format("receive {}.{}", graph.NameOf(a.peer), a.label);
    case Action::Kind::kMove:
      return fmt::format("move {}", a.label);
  }
  return "";
}

LocalType Project(const Graph& graph, const lang::ExprPool& pool, RobotId robot,
                  diag::Diagnostics& diagnostics) {
  return Projection(graph, pool, robot, diagnostics).Run();
}

std::string ToText(const Graph& graph, const lang::ExprPool& pool, const LocalType& type) {
  std::string text;
  for (size_t s = 0; s < type.states.size(); ++s) {
    const LocalState& state = type.states[s];
    if (state.ends) text += fmt::format("{:>4}: end\n", s);
    for (const auto& [action, to] : state.next)
      text += fmt::format("{:>4}: {} -> {}\n", s, Describe(graph, action), to.value);
    for (const auto& [guard, to] : state.choice) {
      text += fmt::format("{:>4}: {} -> {}\n", s,
                          guard.valid() ? "when " + lang::PrintExpr(pool, guard) : "otherwise", to.value);
    }
  }
  return text;
}

}  // namespace rondo::choreo
