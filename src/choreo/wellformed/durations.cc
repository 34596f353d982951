#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using expr::Rational;

/// Times since a fork, in seconds; without `most`: for ever.
struct Times {
  Rational least;
  std::optional<Rational> most;
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

/// From `least` on, up to `most`; without `least`, nobody can say from when on: loops came before.
struct Window {
  std::optional<Rational> least;
  std::optional<Rational> most;
};

/// When a thread is through. A rigid end comes at some time that nobody can choose; a flexible one at any
/// time of its range, when somebody says so. Different ways through a thread may end differently.
struct Ending {
  std::optional<Times> rigid;
  std::optional<Window> flexible;
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
}

bool IsZero(const Ending& e) { return e.rigid && !e.flexible && e.rigid->most && e.rigid->most->IsZero(); }

std::string Text(const Ending& e) {
  if (!e.rigid && !e.flexible->least) return "an unknown time";
  const Times t = e.rigid ? *e.rigid : Times{*e.flexible->least, e.flexible->most};
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
    for (const NodeId start : fork.next) threads.push_back(Thread(start, fork.join));
    const bool good = Compatible(fork, threads);
    Ending all;
    bool flexible = true;
    for (const Ending& t : threads) {
      if (t.rigid) AddRigid(all, *t.rigid);
      flexible = flexible && t.flexible;
    }
    for (const Ending& t : threads) {
      if (flexible) AddFlexible(all, *t.flexible);
    }
    // What was reported once is not reported again further out.
    if (!good) all = {};
    return ends_[id] = all;
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
          AddFlexible(after.ending, From(after.times, {times.least, times.most}));
        } else {
          AddRigid(after.ending, after.times + times);
        }
        after.times = after.times + times;
      } else if (n.kind == NodeKind::kFork) {
        const Ending inner = EndOf(id);
        if (!inner.rigid && !inner.flexible) return {};
        Ending outer;
        Times span = inner.rigid ? *inner.rigid : Times{Rational(0), Rational(0)};
        if (inner.rigid) AddRigid(outer, after.times + *inner.rigid);
        if (inner.flexible) {
          AddFlexible(outer, From(after.times, *inner.flexible));
          const Times waiting{inner.flexible->least.value_or(Rational(0)), inner.flexible->most};
          span = inner.rigid ? Hull(span, waiting) : waiting;
        }
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
    return ends;
  }

  static void Arrive(NodeId to, const Arrival& way, std::map<NodeId, Arrival>& arrivals,
                     std::vector<NodeId>& todo) {
    constexpr size_t kMostUpdates = 8;
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
    // A loop takes any time.
    if (++known.updates > kMostUpdates) {
      known.times.most.reset();
      if (known.ending.rigid) known.ending.rigid->most.reset();
    }
    if (!Same(before, known)) todo.push_back(to);
  }

  template <typename T>
  static bool Same(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a || (a->least == b->least && a->most == b->most));
  }
  static bool Same(const Arrival& a, const Arrival& b) {
    return Same(std::optional(a.times), std::optional(b.times)) && Same(a.ending.rigid, b.ending.rigid) &&
           Same(a.ending.flexible, b.ending.flexible);
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
