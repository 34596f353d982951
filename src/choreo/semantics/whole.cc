#include "choreo/semantics/whole.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::choreo {
namespace {

std::vector<Duration> DurationsOf(const Graph& graph) {
  std::vector<Duration> durations;
  for (const Node& n : graph.nodes) {
    for (const Part& p : n.parts) durations.push_back(p.duration);
  }
  return durations;
}

}  // namespace

Whole::Whole(const Graph& graph) : graph_(graph), ticks_(DurationsOf(graph)) {}

// A joint motion lasts as long as the one that cannot be interrupted; without one, as long as all can.
Duration Whole::StepOf(const Node& motion) const {
  Duration all{expr::Rational(0), std::nullopt, true};
  for (const Part& p : motion.parts) {
    if (!p.duration.interruptible) return p.duration;
    all.least = std::max(all.least, p.duration.least);
    if (p.duration.most && (!all.most || *p.duration.most < *all.most)) all.most = p.duration.most;
  }
  return all;
}

Whole::State Whole::Replace(const State& state, size_t i, const std::vector<NodeId>& by) {
  State next = state;
  next.erase(next.begin() + static_cast<std::ptrdiff_t>(i));
  for (const NodeId id : by) next.push_back({id, false, 0});
  std::ranges::sort(next);
  return next;
}

bool Whole::Ended(const State& state) const {
  return std::ranges::all_of(state, [&](const Mark& m) { return graph_[m.at].kind == NodeKind::kEnd; });
}

std::vector<Whole::Step> Whole::Next(const State& state) const {
  std::vector<Step> steps;
  bool all_move = true;
  for (size_t i = 0; i < state.size(); ++i) {
    const Mark& mark = state[i];
    const Node& n = graph_[mark.at];
    if (n.kind == NodeKind::kEnd) continue;
    all_move = all_move && mark.moving;
    switch (n.kind) {
      case NodeKind::kMessage:
        steps.push_back(
            {fmt::format("{}>{}:{}", n.from.value, n.to.value, n.label), Replace(state, i, n.next)});
        break;
      case NodeKind::kMotion: {
        const Duration d = StepOf(n);
        if (!mark.moving) {
          State next = state;
          next[i] = {mark.at, true, 0};
          std::ranges::sort(next);
          steps.push_back({"", std::move(next)});
        } else if (mark.clock >= ticks_.Least(d)) {
          steps.push_back({"", Replace(state, i, n.next)});
        }
        break;
      }
      case NodeKind::kChoice:
        for (const NodeId id : n.next) steps.push_back({"", Replace(state, i, {id})});
        break;
      case NodeKind::kMerge:
      case NodeKind::kFork:
        steps.push_back({"", Replace(state, i, n.next)});
        break;
      case NodeKind::kJoin: {
        // The threads of the fork that belongs to it.
        const auto waiting = std::ranges::count(state, mark);
        const auto fork = std::ranges::find_if(
            graph_.nodes, [&](const Node& f) { return f.kind == NodeKind::kFork && f.join == mark.at; });
        if (waiting < std::ssize(fork->next)) break;
        State next = state;
        std::erase(next, mark);
        next.push_back({n.next[0], false, 0});
        std::ranges::sort(next);
        steps.push_back({"", std::move(next)});
        break;
      }
      case NodeKind::kEnd:
        break;
    }
  }
  if (!all_move || Ended(state)) return steps;
  State later = state;
  for (Mark& m : later) {
    if (graph_[m.at].kind == NodeKind::kEnd) continue;
    if (m.clock >= ticks_.Most(StepOf(graph_[m.at]))) return steps;
    m.clock = std::min(m.clock + 1, ticks_.enough());
  }
  steps.push_back({"", std::move(later)});
  return steps;
}

}  // namespace rondo::choreo
