#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using expr::Rational;

/// Times since a fork, in seconds; without `most`: for ever.
struct Times {
  Rational least;
  std::optional<Rational> most;
  friend bool operator==(const Times&, const Times&) = default;
};

Times operator+(const Times& a, const Times& b) {
  Times sum{a.least + b.least, std::nullopt};
  if (a.most && b.most) sum.most = *a.most + *b.most;
  return sum;
}

bool Below(const std::optional<Rational>& a, const std::optional<Rational>& b) {
  return !b || (a && *a <= *b);
}

Times Hull(const Times& a, const Times& b) {
  return {std::min(a.least, b.least), Below(a.most, b.most) ? b.most : a.most};
}

bool IsFixed(const Times& t) { return t.most && *t.most == t.least; }

/// For certain from `least` on, up to `most`; without `least`, nobody can say from when on: loops came
/// before. Perhaps, if what comes before takes the least time, from `soonest` on.
struct Window {
  std::optional<Rational> least;
  std::optional<Rational> most;
  Rational soonest;
  std::optional<Rational> latest;
  friend bool operator==(const Window&, const Window&) = default;
};

/// When a thread is through. A rigid end comes at some time that nobody can choose; a flexible one at any
/// time of its range, when somebody says so. Different ways through a thread may end differently.
struct Ending {
  std::optional<Times> rigid;
  std::optional<Window> flexible;
  bool never = false;  ///< it goes on for ever
  bool said = false;   ///< on some way a message comes last
};

void AddRigid(Ending& ending, const Times& times) {
  ending.rigid = ending.rigid ? Hull(*ending.rigid, times) : times;
}

void AddFlexible(Ending& ending, const Window& window) {
  if (!ending.flexible) {
    ending.flexible = window;
    return;
  }
  Window& known = *ending.flexible;
  known.least =
      known.least && window.least ? std::optional(std::max(*known.least, *window.least)) : std::nullopt;
  if (Below(window.most, known.most)) known.most = window.most;
  known.soonest = std::min(known.soonest, window.soonest);
  if (Below(known.latest, window.latest)) known.latest = window.latest;
}

bool IsZero(const Ending& e) { return e.rigid && !e.flexible && e.rigid->most && e.rigid->most->IsZero(); }

std::string Text(const Ending& e) {
  if (!e.rigid && !e.flexible->least) return "an unknown time";
  const Times t = e.rigid ? *e.rigid : Times{*e.flexible->least, e.flexible->most};
  if (t.most && *t.most < t.least) return fmt::format("{} to {} s", t.most->ToString(), t.least.ToString());
  if (IsFixed(t)) return fmt::format("{} s", t.least.ToString());
  if (!t.most) return fmt::format("{} s or more", t.least.ToString());
  return fmt::format("{} to {} s", t.least.ToString(), t.most->ToString());
}

/// Durations add up along the threads of a fork, and all of them must be through at one instant.
class Threads {
 public:
  Threads(const Graph& graph, diag::Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void Run() {
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (graph_.nodes[i].kind == NodeKind::kFork) EndOf(NodeId(i));
    }
  }

 private:
  // Nested forks first; a fork that cannot end at all has no ending.
  Ending EndOf(NodeId id) {
    if (const auto it = ends_.find(id); it != ends_.end()) return it->second;
    ends_[id] = {};
    const Node& fork = graph_[id];
    std::vector<Ending> threads;
    Ending all;
    for (size_t b = 0; b < fork.next.size(); ++b) {
      const std::optional<bool> ends = Ends(fork.next[b], fork.join);
      if (!ends) {
        diagnostics_
            .Report(Kind::kChoreoThreadEndless, fork.facts[b].span,
                    fmt::format("{} may go on for ever here, or not", graph_.Names(fork.threads[b])))
            .Help("let every way through a thread come to its end, or none");
        return ends_[id] = {};
      }
      threads.push_back(*ends ? Thread(fork.next[b], fork.join) : Ending{{}, {}, true});
      all.never = all.never || !*ends;
    }
    if (all.never) return ends_[id] = Endless(fork, threads);
    const bool good = Compatible(fork, threads) && Heard(id, threads);
    bool flexible = true;
    for (const Ending& t : threads) {
      if (t.rigid) AddRigid(all, *t.rigid);
      all.said = all.said || t.said;
      flexible = flexible && t.flexible;
    }
    for (const Ending& t : threads) {
      if (flexible) AddFlexible(all, *t.flexible);
    }
    // What was reported once is not reported again further out.
    if (!good) all = {};
    return ends_[id] = all;
  }

  // Does every way from `start` lead to `join`? No way: false; only some: nothing.
  std::optional<bool> Ends(NodeId start, NodeId join) {
    std::set<NodeId> seen;
    std::map<NodeId, std::vector<NodeId>> before;
    std::vector<NodeId> todo{start};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (!seen.insert(id).second || id == join) continue;
      for (const NodeId next : graph_[id].next) {
        before[next].push_back(id);
        todo.push_back(next);
      }
    }
    if (!seen.contains(join)) return false;
    std::set<NodeId> leading;
    todo = {join};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (leading.insert(id).second) todo.insert(todo.end(), before[id].begin(), before[id].end());
    }
    if (leading.size() == seen.size()) return true;
    return std::nullopt;
  }

  // Threads go on for ever together, and then nothing stands behind them.
  Ending Endless(const Node& fork, const std::vector<Ending>& threads) {
    for (size_t b = 0; b < threads.size(); ++b) {
      if (threads[b].never) continue;
      const auto endless = std::ranges::find(threads, true, &Ending::never) - threads.begin();
      diagnostics_
          .Report(Kind::kChoreoThreadEndless, fork.facts[static_cast<size_t>(endless)].span,
                  "this thread goes on for ever, but others end")
          .At(fork.facts[b].span, "this one ends, and waits for it")
          .Help("let all threads of a `parallel` come to an end, or none");
      return {};
    }
    const Node& behind = graph_[graph_[fork.join].next[0]];
    if (behind.kind == NodeKind::kMessage || behind.kind == NodeKind::kMotion ||
        behind.kind == NodeKind::kFork || behind.kind == NodeKind::kChoice) {
      diagnostics_.Report(Kind::kChoreoUnreachable, behind.span, "this step is never reached")
          .At(fork.span, "these threads go on for ever");
    }
    return {{}, {}, true};
  }

  // How long one step takes, and whether it waits to be interrupted.
  static std::pair<Times, bool> StepOf(const Node& n) {
    Times free{Rational(0), std::nullopt};
    for (const Part& p : n.parts) {
      const Times t{p.duration.least, p.duration.most};
      if (!p.duration.interruptible) return {t, false};
      free.least = std::max(free.least, t.least);
      if (Below(t.most, free.most)) free.most = t.most;
    }
    return {free, true};
  }

  /// When a way may arrive at a node, and how it would end if the thread ended there.
  struct Arrival {
    Times times;
    Ending ending;
    size_t updates = 0;
  };

  Ending Thread(NodeId start, NodeId join) {
    std::map<NodeId, Arrival> arrivals;
    Arrival begin{{Rational(0), Rational(0)}, {}, 0};
    begin.ending.rigid = begin.times;
    std::vector<NodeId> todo{start};
    arrivals.emplace(start, begin);
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (id == join) continue;
      const Node& n = graph_[id];
      Arrival after = arrivals.at(id);
      std::vector<NodeId> next = n.next;
      if (n.kind == NodeKind::kMotion) {
        const auto [times, waits] = StepOf(n);
        after.ending = {};
        if (waits) {
          AddFlexible(after.ending, From(after.times, {times.least, times.most, times.least, times.most}));
        } else {
          AddRigid(after.ending, after.times + times);
        }
        after.times = after.times + times;
      } else if (n.kind == NodeKind::kMessage) {
        after.ending.said = true;
      } else if (n.kind == NodeKind::kFork) {
        const Ending inner = EndOf(id);
        if (!inner.rigid && !inner.flexible) return {};  // reported, or for ever
        Ending outer;
        Times span = inner.rigid ? *inner.rigid : Times{Rational(0), Rational(0)};
        if (inner.rigid) AddRigid(outer, after.times + *inner.rigid);
        if (inner.flexible) {
          AddFlexible(outer, From(after.times, *inner.flexible));
          const Times waiting{inner.flexible->soonest, inner.flexible->latest};
          span = inner.rigid ? Hull(span, waiting) : waiting;
        }
        outer.said = inner.said;
        after.ending = outer;
        after.times = after.times + span;
        next = {graph_[n.join].next};
        if (n.join == join) next = {join};
      }
      for (const NodeId to : next) Arrive(to, after, arrivals, todo);
    }
    const auto end = arrivals.find(join);
    return end == arrivals.end() ? Ending{} : end->second.ending;
  }

  // What may be ended within `window` of its beginning, which comes at some time of `begins`.
  static Window From(const Times& begins, const Window& window) {
    Window ends;
    if (begins.most && window.least) ends.least = *begins.most + *window.least;
    if (window.most) ends.most = begins.least + *window.most;
    ends.soonest = begins.least + window.soonest;
    if (begins.most && window.latest) ends.latest = *begins.most + *window.latest;
    return ends;
  }

  static void Arrive(NodeId to, const Arrival& way, std::map<NodeId, Arrival>& arrivals,
                     std::vector<NodeId>& todo) {
    constexpr size_t kMostUpdates = 40;
    const auto [it, fresh] = arrivals.emplace(to, way);
    Arrival& known = it->second;
    if (fresh) {
      known.updates = 0;
      todo.push_back(to);
      return;
    }
    const Arrival before = known;
    known.times = Hull(known.times, way.times);
    if (way.ending.rigid) AddRigid(known.ending, *way.ending.rigid);
    if (way.ending.flexible) AddFlexible(known.ending, *way.ending.flexible);
    known.ending.said = known.ending.said || way.ending.said;
    if (Same(before, known)) return;
    // What grows again and again is in a loop, and takes any time.
    if (++known.updates > kMostUpdates) {
      known.times.most.reset();
      if (known.ending.rigid) known.ending.rigid->most.reset();
    }
    todo.push_back(to);
  }

  template <typename T>
  static bool Same(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a || *a == *b);
  }
  static bool Same(const Arrival& a, const Arrival& b) {
    return Same(std::optional(a.times), std::optional(b.times)) && Same(a.ending.rigid, b.ending.rigid) &&
           Same(a.ending.flexible, b.ending.flexible) && a.ending.said == b.ending.said;
  }

  bool Compatible(const Node& fork, const std::vector<Ending>& threads) {
    for (size_t i = 0; i < threads.size(); ++i) {
      for (size_t j = i + 1; j < threads.size(); ++j) {
        if (Fit(threads[i], threads[j])) continue;
        Report(fork, threads, i, j);
        return false;
      }
    }
    return true;
  }

  // Who speaks first behind the threads may do so as soon as its own thread allows: the others are through by
  // then, unless there is one who waits for this very message.
  bool Heard(NodeId id, const std::vector<Ending>& threads) {
    const Node& fork = graph_[id];
    std::set<NodeId> seen;
    std::vector<NodeId> todo{fork.join};
    while (!todo.empty()) {
      const NodeId at = todo.back();
      todo.pop_back();
      if (!seen.insert(at).second) continue;
      const Node& n = graph_[at];
      if (n.kind == NodeKind::kMessage) {
        if (!HeardFirst(fork, threads, n)) return false;
      } else if (n.kind == NodeKind::kMerge || n.kind == NodeKind::kChoice || n.kind == NodeKind::kJoin) {
        todo.insert(todo.end(), n.next.begin(), n.next.end());
      }
    }
    return true;
  }

  bool HeardFirst(const Node& fork, const std::vector<Ending>& threads, const Node& message) {
    const auto own =
        std::ranges::find_if(fork.threads, [&](const Scope& s) { return s.contains(message.from); });
    if (own == fork.threads.end()) return true;
    const auto sender = static_cast<size_t>(own - fork.threads.begin());
    if (!threads[sender].flexible) return true;  // fits the windows of all others
    for (size_t j = 0; j < threads.size(); ++j) {
      // Who waits for this very message may be late, unless a thread has ended with another one by then:
      // nobody moves behind that.
      const bool waits = fork.threads[j] == Scope{message.to} && !threads[sender].said;
      if (j == sender || !threads[j].flexible || waits) continue;
      const std::optional<Rational>& sure = threads[j].flexible->least;
      if (sure && *sure <= threads[sender].flexible->soonest) continue;
      diagnostics_
          .Report(Kind::kChoreoNotReady, message.span,
                  fmt::format("`{}` may send this before {} {} through", graph_.NameOf(message.from),
                              graph_.Names(fork.threads[j]), fork.threads[j].size() == 1 ? "is" : "are"))
          .At(fork.facts[j].span,
              fmt::format("this thread takes {}", Text({std::nullopt, threads[j].flexible})))
          .At(fork.facts[sender].span,
              fmt::format("this one may be over after {} s", threads[sender].flexible->soonest.ToString()))
          .Help("let a robot of the thread that takes longest send the first message");
      return false;
    }
    return true;
  }

  static bool Fit(const Ending& a, const Ending& b) {
    const auto follows = [](const Times& rigid, const Window& flexible) {
      return flexible.least && *flexible.least <= rigid.least && Below(rigid.most, flexible.most);
    };
    const auto misses = [](const Window& first, const Window& second) {
      return first.most && (!second.least || *first.most < *second.least);
    };
    if (a.rigid && b.rigid && !(IsFixed(*a.rigid) && IsFixed(*b.rigid) && a.rigid->least == b.rigid->least))
      return false;
    if (a.rigid && b.flexible && !follows(*a.rigid, *b.flexible)) return false;
    if (b.rigid && a.flexible && !follows(*b.rigid, *a.flexible)) return false;
    return !a.flexible || !b.flexible ||
           (!misses(*a.flexible, *b.flexible) && !misses(*b.flexible, *a.flexible));
  }

  void Report(const Node& fork, const std::vector<Ending>& threads, size_t i, size_t j) {
    const bool still = IsZero(threads[i]) || IsZero(threads[j]);
    const size_t at = IsZero(threads[i]) ? i : j;
    const size_t other = at == i ? j : i;
    const std::string names = graph_.Names(fork.threads[at]);
    if (still) {
      diagnostics_
          .Report(Kind::kChoreoThreadStill, fork.facts[at].span,
                  fmt::format("no time passes for {} while others move", names))
          .At(fork.facts[other].span, fmt::format("this thread takes {}", Text(threads[other])))
          .Note(
              "time passes for every robot: a thread without a motion ends at the instant at which it began")
          .Help(fmt::format("let {} idle", names));
      return;
    }
    diagnostics_
        .Report(Kind::kChoreoDurationOutside, fork.facts[at].span,
                fmt::format("this thread takes {}, which does not fit to {}", Text(threads[at]),
                            Text(threads[other])))
        .At(fork.facts[other].span, fmt::format("this one takes {}", Text(threads[other])))
        .Note("all threads of a `parallel` are through at one instant")
        .Help("let one of them idle at its end: it waits for the others");
  }

  const Graph& graph_;
  diag::Diagnostics& diagnostics_;
  std::map<NodeId, Ending> ends_;
};

}  // namespace

void CheckDurations(const Graph& graph, diag::Diagnostics& diagnostics) { Threads(graph, diagnostics).Run(); }

}  // namespace rondo::choreo
