#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

/// A joint motion that was begun, and who has heard since that it ends.
struct Track {
  NodeId motion;
  NodeId first;    ///< the first message behind it
  Scope informed;  ///< who took part in messages since
  friend auto operator<=>(const Track&, const Track&) = default;
};

class Synchronisation {
 public:
  Synchronisation(const Graph& graph, diag::Diagnostics& diagnostics)
      : graph_(graph), diagnostics_(diagnostics) {}

  // Each track goes its own way: what one motion asks of the steps behind it does not depend on others.
  void Run() {
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& n = graph_.nodes[i];
      if (n.kind == NodeKind::kMotion) Go(n, {NodeId(i), {}, {}});
    }
    while (!todo_.empty()) {
      auto [id, track] = std::move(todo_.back());
      todo_.pop_back();
      Follow(id, std::move(track));
    }
  }

 private:
  void Go(const Node& from, const Track& track) {
    for (const NodeId next : from.next) {
      if (seen_.emplace(next, track).second) todo_.emplace_back(next, track);
    }
  }

  void Follow(NodeId id, Track track) {
    const Node& n = graph_[id];
    if (n.kind == NodeKind::kMotion) return Move(n, track);
    if (n.kind == NodeKind::kMessage) Say(id, n, track);
    Go(n, track);
  }

  void Say(NodeId id, const Node& n, Track& track) {
    const Scope& moving = graph_[track.motion].scope;
    const auto concerns = [&](RobotId r) { return moving.contains(r) || track.informed.contains(r); };
    if (!concerns(n.from) && !concerns(n.to)) return;
    if (!track.first.valid()) {
      track.first = id;
      CheckReady(n, track);
    } else if (!track.informed.contains(n.from)) {
      diagnostics_
          .Report(Kind::kChoreoUnordered, n.span,
                  fmt::format("`{}` may send this before another message arrives", graph_.NameOf(n.from)))
          .At(graph_[track.first].span, "nothing orders it behind this message")
          .At(graph_[track.motion].span, "both follow this motion")
          .Note(fmt::format("`{}` has heard from nobody since the motion", graph_.NameOf(n.from)))
          .Help(fmt::format("let `{}` wait for a message first", graph_.NameOf(n.from)));
    }
    track.informed.insert({n.from, n.to});
  }

  // Who sends first behind a motion must be the one who could not be interrupted, if there is one.
  void CheckReady(const Node& n, const Track& track) {
    for (const Part& p : graph_[track.motion].parts) {
      if (p.duration.interruptible || p.robot == n.from) continue;
      diagnostics_
          .Report(Kind::kChoreoNotReady, n.span,
                  fmt::format("`{}` sends while `{}` may still be moving", graph_.NameOf(n.from),
                              graph_.NameOf(p.robot)))
          .At(p.span, "this motion cannot be interrupted")
          .Help(fmt::format("let `{}` say when it has finished: it should send the first message",
                            graph_.NameOf(p.robot)));
      return;
    }
  }

  void Move(const Node& n, const Track& track) {
    const Node& before = graph_[track.motion];
    // A robot that is alone knows its own progress.
    if (n.scope.size() == 1 && before.scope == n.scope) return;
    if (std::ranges::none_of(n.scope, [&](RobotId r) { return before.scope.contains(r); })) return;
    if (!track.first.valid()) {
      diagnostics_
          .Report(Kind::kChoreoMotionAfterMotion, n.span,
                  fmt::format("{} change their motion without a message", graph_.Names(n.scope)))
          .At(before.span, "until here they do this")
          .Help("let a robot whose motion has ended tell the others");
      return;
    }
    Scope deaf;
    for (const RobotId r : before.scope) {
      if (!track.informed.contains(r)) deaf.insert(r);
    }
    if (deaf.empty()) return;
    diagnostics_
        .Report(Kind::kChoreoNotInformed, n.span,
                fmt::format("{} {} not told that the motion changes", graph_.Names(deaf),
                            deaf.size() == 1 ? "is" : "are"))
        .At(before.span, "it takes part in this motion")
        .Help("send it a message, or receive one from it, before the next motion");
  }

  const Graph& graph_;
  diag::Diagnostics& diagnostics_;
  std::vector<std::pair<NodeId, Track>> todo_;
  std::set<std::pair<NodeId, Track>> seen_;
};

}  // namespace

void CheckSynchronisation(const Graph& graph, diag::Diagnostics& diagnostics) {
  Synchronisation(graph, diagnostics).Run();
}

}  // namespace rondo::choreo
