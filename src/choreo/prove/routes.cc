#include "choreo/prove/routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

namespace rondo::choreo {
namespace {

constexpr size_t kMostTries = 400;

/// Walks along one way, which some decisions determine, and copies it.
class Walk {
 public:
  enum class End : uint8_t {
    kThere,  ///< at the node
    kJoin,   ///< at the end of the thread
    kAsks,   ///< at a choice, without a decision
    kLost,   ///< the way never comes to the node, or goes round too often
  };

  Walk(const Graph& graph, NodeId node, size_t visit, size_t rounds, const std::vector<size_t>& decisions)
      : graph_(graph), node_(node), visit_(visit), rounds_(rounds), decisions_(decisions) {
    route_.graph = graph;
    route_.graph.nodes.clear();
  }

  End Run() {
    NodeId first;
    NodeId last;
    const End end = Along(graph_.start, NodeId(), NodeId(), first, last);
    route_.graph.start = first;
    return end;
  }
  Route& route() { return route_; }
  /// Returns how many alternatives there are where a decision is missing.
  size_t alternatives() const { return alternatives_; }

 private:
  Node& Copied(NodeId id) { return route_.graph[id]; }
  NodeId Copy(NodeId from) {
    Node node = graph_[from];
    node.next.clear();
    route_.graph.nodes.push_back(std::move(node));
    return NodeId(route_.graph.nodes.size() - 1);
  }
  NodeId Stop(const Scope& scope) {
    Node end;
    end.kind = NodeKind::kEnd;
    end.scope = scope;
    route_.graph.nodes.push_back(std::move(end));
    return NodeId(route_.graph.nodes.size() - 1);
  }

  // After the node there is nothing but the end of the thread (`after`), or of everything. A choice keeps its
  // alternatives, a fork its threads.
  void Finish(NodeId id, NodeId after) {
    if (!after.valid()) after = Stop(Copied(id).scope);
    if (Copied(id).kind == NodeKind::kChoice) {
      Copied(id).next.assign(Copied(id).guard_terms.size(), after);
    } else if (Copied(id).kind == NodeKind::kFork) {
      const NodeId join = Copy(Copied(id).join);
      Copied(join).next = {after};
      Copied(id).join = join;
      Copied(id).next.assign(Copied(id).threads.size(), join);
    } else {
      Copied(id).next = {after};
    }
  }

  void Link(NodeId& first, NodeId& last, NodeId id) {
    if (last.valid()) {
      Copied(last).next.push_back(id);
    } else {
      first = id;
    }
    last = id;
  }

  // To the node, or to the end of the thread (`join`, whose copy is `after`). `first` and `last`: the copies of what was
  // passed, the node included.
  End Along(NodeId at, NodeId join, NodeId after, NodeId& first, NodeId& last) {
    while (at != join) {
      const Node& n = graph_[at];
      const NodeId id = Copy(at);
      Link(first, last, id);
      if (at == node_ && ++visits_[at] == visit_) {
        route_.target = id;
        route_.rounds = std::max(route_.rounds, visit_);
        Finish(id, after);
        return End::kThere;
      }
      switch (n.kind) {
        case NodeKind::kMotion:
        case NodeKind::kMessage:
          at = n.next[0];
          break;
        case NodeKind::kMerge:
          if (++rounds_at_[at] > rounds_) return End::kLost;
          route_.rounds = std::max(route_.rounds, rounds_at_[at]);
          if (rounds_at_[at] > 1) route_.turns.push_back({n.span, fmt::format("round {}", rounds_at_[at])});
          at = n.next[0];
          break;
        case NodeKind::kChoice: {
          if (used_ == decisions_.size()) {
            alternatives_ = n.next.size();
            return End::kAsks;
          }
          const size_t taken = decisions_[used_++];
          Copied(id).guards = {n.guards[taken]};
          Copied(id).guard_terms = {n.guard_terms[taken]};
          route_.turns.push_back(
              {graph_[n.next[taken]].span, fmt::format("alternative {} of {}", taken + 1, n.next.size())});
          at = n.next[taken];
          break;
        }
        case NodeKind::kFork: {
          const End end = Threads(at, id);
          if (end != End::kJoin) return end;
          last = Copied(id).join;
          at = graph_[n.join].next[0];
          break;
        }
        case NodeKind::kJoin:
        case NodeKind::kEnd:
          return End::kLost;
      }
    }
    return End::kJoin;
  }

  // All threads to their ends; or that in which the node is, to the node, and nothing of the others.
  End Threads(NodeId fork, NodeId copy) {
    const Node& n = graph_[fork];
    const NodeId join = Copy(n.join);
    Copied(copy).join = join;
    Copied(copy).next.assign(n.next.size(), join);
    std::vector<size_t> order;
    for (size_t b = 0; b < n.next.size(); ++b) order.push_back(b);
    std::ranges::stable_sort(order, {}, [&](size_t b) { return IsWithin(n.next[b], n.join) ? 0 : 1; });
    for (const size_t b : order) {
      NodeId first;
      NodeId last;
      const End end = Along(n.next[b], n.join, join, first, last);
      if (first.valid()) Copied(copy).next[b] = first;
      if (end == End::kThere) {
        const NodeId stop = Stop(Copied(join).scope);
        Copied(join).next = {stop};
      }
      if (end != End::kJoin) return end;
      if (last.valid()) Copied(last).next.push_back(join);
    }
    return End::kJoin;
  }

  bool IsWithin(NodeId from, NodeId join) const {
    std::set<NodeId> seen;
    std::vector<NodeId> open{from};
    while (!open.empty()) {
      const NodeId at = open.back();
      open.pop_back();
      if (at == join || !seen.insert(at).second) continue;
      if (at == node_) return true;
      const auto& next = graph_[at].next;
      open.insert(open.end(), next.begin(), next.end());
    }
    return false;
  }

  const Graph& graph_;
  NodeId node_;
  size_t visit_;
  size_t rounds_;
  const std::vector<size_t>& decisions_;
  size_t used_ = 0, alternatives_ = 0;
  std::map<NodeId, size_t> visits_, rounds_at_;
  Route route_;
};

}  // namespace

Routes RoutesTo(const Graph& graph, NodeId node, size_t rounds, size_t most) {
  Routes routes;
  size_t tries = 0;
  for (size_t visit = 1; visit <= rounds; ++visit) {
    std::deque<std::vector<size_t>> open{{}};
    for (; !open.empty(); open.pop_front()) {
      if (++tries > kMostTries || routes.all.size() == most) {
        routes.complete = false;
        return routes;
      }
      Walk walk(graph, node, visit, rounds, open.front());
      const Walk::End end = walk.Run();
      if (end == Walk::End::kThere) routes.all.push_back(std::move(walk.route()));
      if (end != Walk::End::kAsks) continue;
      for (size_t b = 0; b < walk.alternatives(); ++b) {
        open.push_back(open.front());
        open.back().push_back(b);
      }
    }
  }
  return routes;
}

}  // namespace rondo::choreo
