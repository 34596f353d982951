#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

std::string Text(const Duration& d) {
  return fmt::format("[{} s, {}", d.least.ToString(), d.most ? d.most->ToString() + " s]" : "inf)");
}

class Time {
 public:
  Time(const Graph& graph, diag::Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void Run() {
    for (const Node& n : graph_.nodes) {
      if (n.kind == NodeKind::kMotion) Step(n);
    }
    // For certain time passes in a step if some motion of it has to last.
    const auto still = [](const Node& n) {
      return n.kind != NodeKind::kMotion ||
             std::ranges::all_of(n.parts, [](const Part& p) { return p.duration.least.IsZero(); });
    };
    const auto silent = [](const Node& n) {
      return n.kind != NodeKind::kMotion && n.kind != NodeKind::kMessage;
    };
    const NodeId unguarded = Cycle(silent);
    if (unguarded.valid()) {
      diagnostics_
          .Report(Kind::kChoreoUnguarded, graph_[unguarded].span, "this loop may go round without a step")
          .Help("put a message or a motion on every way back to its beginning");
      return;
    }
    if (const NodeId zeno = Cycle(still); zeno.valid()) {
      diagnostics_.Report(Kind::kChoreoZeno, graph_[zeno].span, "this loop may go round without time passing")
          .Note("no motion on some way round it has to last: infinitely many rounds fit into no time at all")
          .Help("give a motion on every way round it a least duration: `[0.1 s, inf)`");
    }
  }

 private:
  void Step(const Node& n) {
    std::vector<const Part*> rigid;
    for (const Part& p : n.parts) {
      if (!p.duration.interruptible) rigid.push_back(&p);
    }
    if (rigid.size() > 1 && !(graph_.equal_durations && AreEqual(rigid))) {
      auto& report = diagnostics_.Report(Kind::kChoreoTwoRigid, rigid[1]->span,
                                         "two motions of one step cannot be interrupted");
      report.At(rigid[0]->span, "this one, too")
          .Note("neither robot can wait for the other: they need not end at the same time")
          .Help("let one of them idle, or separate them in the threads of a `parallel`");
      if (AreEqual(rigid)) report.Help("`option equal_durations` admits motions of one fixed duration");
      return;
    }
    for (const Part& p : n.parts) {
      for (const Part& q : n.parts) {
        if (&p == &q || !q.duration.interruptible) continue;
        const bool rigid_p = !p.duration.interruptible;
        const bool early = rigid_p ? q.duration.least > p.duration.least
                                   : p.duration.most && q.duration.least > *p.duration.most;
        const bool late =
            rigid_p && q.duration.most && (!p.duration.most || *q.duration.most < *p.duration.most);
        if (!early && !late) continue;
        diagnostics_
            .Report(Kind::kChoreoDurationOutside, q.span,
                    fmt::format("this motion takes {}, which does not fit to {}", Text(q.duration),
                                Text(p.duration)))
            .At(p.span, fmt::format("this one takes {}", Text(p.duration)));
        return;
      }
    }
  }

  static bool AreEqual(const std::vector<const Part*>& parts) {
    for (const Part* p : parts) {
      if (!p->duration.most || *p->duration.most != p->duration.least) return false;
      if (p->duration.least != parts[0]->duration.least) return false;
    }
    return true;
  }

  using Inside = std::function<bool(const Node&)>;

  // All threads of a fork wait for each other: it is passed over such nodes only if each thread can be.
  bool Passes(NodeId fork, const Inside& inside) const {
    const Node& f = graph_[fork];
    return std::ranges::all_of(f.next, [&](NodeId start) { return Leads(start, f.join, inside); });
  }

  bool Leads(NodeId start, NodeId join, const Inside& inside) const {
    std::set<NodeId> seen;
    std::vector<NodeId> todo{start};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (id == join) return true;
      if (!inside(graph_[id]) || !seen.insert(id).second) continue;
      if (graph_[id].kind == NodeKind::kFork) {
        if (Passes(id, inside)) todo.push_back(graph_[id].join);
      } else {
        todo.insert(todo.end(), graph_[id].next.begin(), graph_[id].next.end());
      }
    }
    return false;
  }

  // A node on a cycle of such nodes.
  NodeId Cycle(const Inside& inside) const {
    std::set<NodeId> closed;  // joins that are not reached without others
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (graph_.nodes[i].kind == NodeKind::kFork && !Passes(NodeId(i), inside))
        closed.insert(graph_.nodes[i].join);
    }
    enum class Mark : uint8_t { kNew, kOpen, kDone };
    std::vector<Mark> marks(graph_.nodes.size(), Mark::kNew);
    std::vector<std::pair<NodeId, size_t>> path;
    for (size_t start = 0; start < graph_.nodes.size(); ++start) {
      if (marks[start] != Mark::kNew || !inside(graph_.nodes[start])) continue;
      path.assign(1, {NodeId(start), 0});
      marks[start] = Mark::kOpen;
      while (!path.empty()) {
        const NodeId id = path.back().first;
        const auto& next = graph_[id].next;
        if (path.back().second == next.size()) {
          marks[id.index()] = Mark::kDone;
          path.pop_back();
          continue;
        }
        const NodeId to = next[path.back().second++];
        if (!inside(graph_[to]) || closed.contains(to)) continue;
        if (marks[to.index()] == Mark::kOpen) return to;
        if (marks[to.index()] == Mark::kDone) continue;
        marks[to.index()] = Mark::kOpen;
        path.emplace_back(to, 0);
      }
    }
    return {};
  }

  const Graph& graph_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace

void CheckTime(const Graph& graph, diag::Diagnostics& diagnostics) { Time(graph, diagnostics).Run(); }

}  // namespace rondo::choreo
