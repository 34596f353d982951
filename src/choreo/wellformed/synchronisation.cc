#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

/// What is known, on every way from a motion to some node, of who has heard that the motion ends.
struct News {
  bool quiet = false;   ///< on some way nobody has spoken yet, or not since the last join
  bool spoken = false;  ///< on some way somebody has
  NodeId first;         ///< a message that was the first one
  Scope informed;       ///< who took part in messages since, on every way on which somebody has spoken
  /// Who knows that the motion has ended, on every way: at first who could not be interrupted. Nothing if all
  /// can be, so that whoever speaks ends it.
  std::optional<Scope> ready;
  bool joined = false;  ///< threads have joined since, on some way
  bool told = false;  ///< on some way `ready` is who was told in its thread, not who could not be interrupted
  friend bool operator==(const News&, const News&) = default;
};

Scope Both(const Scope& a, const Scope& b) {
  Scope both;
  std::ranges::set_intersection(a, b, std::inserter(both, both.end()));
  return both;
}

// Of two ways that meet: what holds on both.
void Meet(News& known, const News& way) {
  if (way.spoken) known.informed = known.spoken ? Both(known.informed, way.informed) : way.informed;
  if (!known.first.valid()) known.first = way.first;
  if (way.ready) known.ready = known.ready ? Both(*known.ready, *way.ready) : *way.ready;
  known.quiet = known.quiet || way.quiet;
  known.spoken = known.spoken || way.spoken;
  known.joined = known.joined || way.joined;
  known.told = known.told || way.told;
}

class Synchronisation {
 public:
  Synchronisation(const Graph& graph, diag::Diagnostics& diagnostics)
      : graph_(graph), diagnostics_(diagnostics) {}

  // Each motion for itself: what it asks of the steps behind it does not depend on others.
  void Run() {
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (graph_.nodes[i].kind == NodeKind::kMotion) Follow(NodeId(i));
    }
  }

 private:
  // Up to the next motions.
  void Follow(NodeId motion) {
    motion_ = motion;
    news_.clear();
    News begin;
    begin.quiet = true;
    const Scope rigid = Rigid(graph_[motion]);
    if (!rigid.empty()) begin.ready = rigid;
    Go(graph_[motion].next, begin);
    while (!todo_.empty()) {
      const NodeId id = todo_.back();
      todo_.pop_back();
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kMotion) continue;
      News after = news_.at(id);
      if (n.kind == NodeKind::kMessage) Hear(id, n, after);
      // Robots of other threads join: they, too, must learn that all motions have ended.
      if (n.kind == NodeKind::kJoin) Join(after);
      Go(n.next, after);
    }
    for (const auto& [id, news] : news_) {
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kMessage) CheckMessage(id, n, news);
      if (n.kind == NodeKind::kMotion) CheckMotion(n, news);
    }
  }

  void Go(const std::vector<NodeId>& to, const News& news) {
    for (const NodeId next : to) {
      const auto [it, fresh] = news_.emplace(next, news);
      if (!fresh) {
        const News before = it->second;
        Meet(it->second, news);
        if (it->second == before) continue;
      }
      todo_.push_back(next);
    }
  }

  static void Hear(NodeId id, const Node& n, News& news) {
    if (news.quiet) {
      news.informed.clear();
      if (!news.first.valid()) news.first = id;
    }
    news.informed.insert({n.from, n.to});
    news.quiet = false;
    news.spoken = true;
  }

  static void Join(News& news) {
    news.joined = true;
    if (!news.spoken) return;
    // Who was told in its thread knows; where nobody was, who could not be interrupted.
    if (news.quiet) {
      news.informed = news.ready ? Both(news.informed, *news.ready) : news.informed;
    }
    news.ready = std::exchange(news.informed, {});
    news.told = true;
    news.first = {};
    news.quiet = true;
    news.spoken = false;
  }

  // The robots whose motion cannot be interrupted.
  static Scope Rigid(const Node& motion) {
    Scope rigid;
    for (const Part& p : motion.parts) {
      if (!p.duration.interruptible) rigid.insert(p.robot);
    }
    return rigid;
  }

  void CheckMessage(NodeId id, const Node& n, const News& news) {
    if (news.quiet) CheckReady(id, n, news);
    if (news.quiet) CheckLeast(n);
    if (!news.spoken || news.informed.contains(n.from)) return;
    diagnostics_
        .Report(Kind::kChoreoUnordered, n.span,
                fmt::format("`{}` may send this before another message arrives", graph_.NameOf(n.from)))
        .At(graph_[news.first].span, "nothing orders it behind this message")
        .At(graph_[motion_].span, "both follow this motion")
        .Note(fmt::format("`{}` has heard from nobody since {}", graph_.NameOf(n.from),
                          news.joined ? "the threads joined" : "the motion"))
        .Help(fmt::format("let `{}` wait for a message first", graph_.NameOf(n.from)));
  }

  // Who sends first behind a motion must know that it has ended.
  void CheckReady(NodeId id, const Node& n, const News& news) {
    if (!news.ready || news.ready->contains(n.from)) return;
    const bool together = !news.told && EndsWithIt(id, n.from);
    if (graph_.equal_durations && together) return;
    const Node& motion = graph_[motion_];
    const auto part =
        std::ranges::find_if(motion.parts, [](const Part& p) { return !p.duration.interruptible; });
    const std::string who = !news.told && part != motion.parts.end() ? "`" + graph_.NameOf(part->robot) + "`"
                                                                     : graph_.Names(motion.scope);
    auto& report = diagnostics_.Report(
        Kind::kChoreoNotReady, n.span,
        fmt::format("`{}` sends while {} may still be moving", graph_.NameOf(n.from), who));
    if (news.told) {
      report.At(motion.span, "the last motion of another thread, whose end is told in that thread only");
      if (!news.ready->empty())
        report.Help(fmt::format("let one of {} send the first message", graph_.Names(*news.ready)));
    } else {
      report.At(part->span, "this motion cannot be interrupted")
          .Help(fmt::format("let {} say when it has finished: it should send the first message", who));
      if (together) report.Help("`option equal_durations` admits motions of one fixed duration");
    }
  }

  // Where all motions of a step can be interrupted, whoever speaks first ends it: not before all of them may
  // end.
  void CheckLeast(const Node& n) {
    const Node& motion = graph_[motion_];
    if (!Rigid(motion).empty()) return;
    const Part* longest = nullptr;
    expr::Rational own(0);
    for (const Part& p : motion.parts) {
      if (longest == nullptr || p.duration.least > longest->duration.least) longest = &p;
      if (p.robot == n.from || p.robot == n.to) own = std::max(own, p.duration.least);
    }
    if (longest == nullptr || longest->duration.least <= own) return;
    diagnostics_
        .Report(Kind::kChoreoNotReady, n.span,
                fmt::format("`{}` may send this before `{}` can be interrupted", graph_.NameOf(n.from),
                            graph_.NameOf(longest->robot)))
        .At(longest->span, fmt::format("this motion takes {} s at least", longest->duration.least.ToString()))
        .Help(fmt::format("let `{}` send the first message, or receive it", graph_.NameOf(longest->robot)));
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

  void CheckMotion(const Node& n, const News& news) {
    const Node& before = graph_[motion_];
    // A robot that is alone in its thread knows its own progress, but not that of others that it joins.
    if (n.scope.size() == 1 && before.scope == n.scope && !news.joined) return;
    if (std::ranges::none_of(n.scope, [&](RobotId r) { return before.scope.contains(r); })) return;
    if (news.quiet) {
      // Everybody knows when its own motion has ended, and all of them ended at one instant.
      if (graph_.equal_durations && !news.told && Rigid(before) == before.scope && !news.spoken) return;
      auto& report = diagnostics_.Report(
          Kind::kChoreoMotionAfterMotion, n.span,
          fmt::format("{} change{} {} motion without a message", graph_.Names(n.scope),
                      n.scope.size() == 1 ? "s" : "", n.scope.size() == 1 ? "its" : "their"));
      report.At(before.span, n.scope == before.scope
                                 ? n.scope.size() == 1 ? "until here it does this" : "until here they do this"
                                 : "this motion ends before");
      if (news.joined) report.Note("robots of different threads do not know when the others are through");
      report.Help("let a robot whose motion has ended tell the others");
      return;
    }
    Scope deaf;
    for (const RobotId r : before.scope) {
      if (!news.informed.contains(r)) deaf.insert(r);
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
  NodeId motion_;
  std::map<NodeId, News> news_;
  std::vector<NodeId> todo_;
  std::vector<std::vector<NodeId>> before_;  // predecessors
};

}  // namespace

void CheckSynchronisation(const Graph& graph, diag::Diagnostics& diagnostics) {
  Synchronisation(graph, diagnostics).Run();
}

}  // namespace rondo::choreo
