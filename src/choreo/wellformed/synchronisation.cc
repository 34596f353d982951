#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

/// A joint motion that was begun, and who has heard since that it ends.
struct Track {
  NodeId motion;
  NodeId first;    ///< the first message behind it, or behind the last join since
  Scope informed;  ///< who took part in messages since
  /// Who knows that it has ended: at first who could not be interrupted; nobody if all can, so that whoever
  /// speaks ends it.
  Scope ready;
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
      if (n.kind == NodeKind::kMotion) Go(n, {NodeId(i), {}, {}, Rigid(n)});
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
    // Robots of other threads join: they, too, must learn that all motions have ended.
    if (n.kind == NodeKind::kJoin && track.first.valid()) {
      track.ready = std::exchange(track.informed, {});
      track.first = {};
    }
    Go(n, track);
  }

  // The robots whose motion cannot be interrupted.
  static Scope Rigid(const Node& motion) {
    Scope rigid;
    for (const Part& p : motion.parts) {
      if (!p.duration.interruptible) rigid.insert(p.robot);
    }
    return rigid;
  }

  void Say(NodeId id, const Node& n, Track& track) {
    if (!track.first.valid()) {
      track.first = id;
      CheckReady(id, n, track);
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

  // Who sends first behind a motion must know that it has ended.
  void CheckReady(NodeId id, const Node& n, const Track& track) {
    if (track.ready.empty() || track.ready.contains(n.from)) return;
    if (graph_.equal_durations && EndsWithIt(id, n.from)) return;
    const RobotId robot = *track.ready.begin();
    const Node& motion = graph_[track.motion];
    const auto part = std::ranges::find_if(motion.parts, [&](const Part& p) { return p.robot == robot; });
    auto& report = diagnostics_.Report(Kind::kChoreoNotReady, n.span,
                                       fmt::format("`{}` sends while `{}` may still be moving",
                                                   graph_.NameOf(n.from), graph_.NameOf(robot)));
    report.At(part == motion.parts.end() ? motion.span : part->span, "this motion cannot be interrupted")
        .Help(fmt::format("let `{}` say when it has finished: it should send the first message",
                          graph_.NameOf(robot)));
    if (!graph_.equal_durations && EndsWithIt(id, n.from))
      report.Help("`option equal_durations` admits motions of one fixed duration");
  }

  // Did the robot itself last do what cannot be interrupted? Then it knows when that ended; where motions of
  // one fixed duration are admitted, everything else that could not be interrupted ended at this instant,
  // too.
  bool EndsWithIt(NodeId id, RobotId robot) {
    if (before_.empty()) {
      before_.resize(graph_.nodes.size());
      for (size_t i = 0; i < graph_.nodes.size(); ++i) {
        for (const NodeId next : graph_.nodes[i].next) before_[next.index()].emplace_back(i);
      }
    }
    std::set<NodeId> seen;
    std::vector<NodeId> todo{id};
    bool found = false;
    while (!todo.empty()) {
      const NodeId at = todo.back();
      todo.pop_back();
      if (!seen.insert(at).second) continue;
      const Node& n = graph_[at];
      if (!n.scope.contains(robot)) continue;  // another thread
      if (n.kind == NodeKind::kMotion) {
        if (!Rigid(n).contains(robot)) return false;
        found = true;
      } else {
        todo.insert(todo.end(), before_[at.index()].begin(), before_[at.index()].end());
      }
    }
    return found;
  }

  void Move(const Node& n, const Track& track) {
    const Node& before = graph_[track.motion];
    // A robot that is alone knows its own progress.
    if (n.scope.size() == 1 && before.scope == n.scope) return;
    if (std::ranges::none_of(n.scope, [&](RobotId r) { return before.scope.contains(r); })) return;
    if (!track.first.valid()) {
      // Everybody knows when its own motion has ended, and all of them ended at one instant.
      if (graph_.equal_durations && Rigid(before) == before.scope) return;
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
  std::vector<std::vector<NodeId>> before_;  // predecessors
};

}  // namespace

void CheckSynchronisation(const Graph& graph, diag::Diagnostics& diagnostics) {
  Synchronisation(graph, diagnostics).Run();
}

}  // namespace rondo::choreo
