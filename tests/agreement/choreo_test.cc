// Projections of random choreographies: what the whole may say, its parts may say together, and they never
// get stuck.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>

#include "choreo/graph/lower.h"
#include "choreo/project/project.h"
#include "choreo/syntax/parser.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

// Random choreographies, most of which are not well-formed.
class Texts {
 public:
  explicit Texts(uint64_t seed) : rng_(seed) {}

  std::string Whole() {
    std::string text =
        "robot R {\n state x : length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n motion "
        "Go() noninterruptible [1 s, 1 s] "
        "{}\n}\n"
        "world W { a: R b: R c: R }\nchoreography C in W {\n";
    return text + Steps("abc", 3) + "}\n";
  }

 private:
  size_t Pick(size_t n) { return static_cast<size_t>(rng_() % n); }

  std::string Message(const std::string& robots) {
    const size_t from = Pick(robots.size());
    const size_t to = (from + 1 + Pick(robots.size() - 1)) % robots.size();
    return std::string(1, robots[from]) + " -> " + robots[to] + ": l" + std::to_string(Pick(3)) + "()\n";
  }

  std::string Motion(const std::string& robots) {
    const size_t going = Pick(robots.size() + 1);
    std::string text = "{ ";
    for (size_t r = 0; r < robots.size(); ++r)
      text += std::string(r == 0 ? "" : ", ") + robots[r] + ": " + (r == going ? "Go()" : "Idle()");
    return text + " }\n";
  }

  std::string Steps(const std::string& robots, int depth) {
    std::string text;
    const size_t count = 1 + Pick(3);
    for (size_t i = 0; i < count; ++i) text += Step(robots, depth);
    return text;
  }

  std::string Step(const std::string& robots, int depth) {
    if (robots.size() == 1) return robots + (Pick(2) == 0 ? ": Go()\n" : ": Idle()\n");
    switch (depth == 0 ? Pick(2) : Pick(7)) {
      case 0:
      case 1:
        return Message(robots);
      case 2:
        return Motion(robots);
      case 3: {
        const char chooser = robots[Pick(robots.size())];
        std::string text = std::string("choose at ") + chooser + " {\n";
        for (int b = 0; b < 2; ++b) {
          const char other = robots[(robots.find(chooser) + 1 + Pick(robots.size() - 1)) % robots.size()];
          text += std::string("when ") + chooser + ".x > 0 m {\n" + chooser + " -> " + other + ": k" +
                  std::to_string(b) + "()\n" + Steps(robots, depth - 1) + "}\n";
        }
        return text + "}\n";
      }
      case 4: {
        const char last = robots.back();
        const std::string rest = robots.substr(0, robots.size() - 1);
        // Durations are not counted here, so a robot that is alone moves once.
        const std::string first = rest.size() == 1 ? Step(rest, depth - 1) : Steps(rest, depth - 1);
        return "parallel {\nthread {\n" + first + "}\nthread {\n" + Step(std::string(1, last), depth - 1) +
               "}\n}\n";
      }
      case 5:
        return "rec X" + std::to_string(depth) + " {\n" + Steps(robots, depth - 1) + Leave(robots, depth) +
               "}\n";
      default:
        return Message(robots) + Motion(robots);
    }
  }

  // Either round again or on; the others are told by one who knows.
  std::string Leave(const std::string& robots, int depth) {
    const char chooser = robots[Pick(robots.size())];
    std::string again, on;
    for (const char r : robots) {
      if (r == chooser) continue;
      again += std::string(1, chooser) + " -> " + r + ": again()\n";
      on += std::string(1, chooser) + " -> " + r + ": on()\n";
    }
    return std::string("choose at ") + chooser + " {\nwhen " + chooser + ".x > 0 m {\n" + again +
           "continue X" + std::to_string(depth) + " }\nwhen " + chooser + ".x <= 0 m {\n" + on + "}\n}\n";
  }

  std::mt19937_64 rng_;
};

// Where each robot is, and whether it is moving there.
using Locals = std::vector<std::pair<StateId, bool>>;

struct Team {
  const Graph& graph;
  std::vector<LocalType> types;

  const LocalState& At(const Locals& s, size_t r) const { return types[r].states[s[r].first.index()]; }

  static const std::pair<const Action, StateId>* MoveOf(const LocalState& state) {
    const auto it = std::ranges::find_if(
        state.next, [](const auto& step) { return step.first.kind == Action::Kind::kMove; });
    return it == state.next.end() ? nullptr : &*it;
  }

  // Time begins to pass for all or for none: whoever does not move yet begins to.
  std::optional<Locals> Begin(const Locals& s) const {
    Locals next = s;
    bool changed = false;
    for (size_t r = 0; r < types.size(); ++r) {
      if (s[r].second || At(s, r).ends) continue;
      const auto* move = MoveOf(At(s, r));
      if (move == nullptr) return std::nullopt;
      next[r] = {move->second, true};
      changed = true;
    }
    return changed ? std::optional(next) : std::nullopt;
  }

  bool AllMove(const Locals& s) const {
    for (size_t r = 0; r < types.size(); ++r) {
      if (!s[r].second && !At(s, r).ends) return false;
    }
    return true;
  }

  // What happens without a message: time, choices, and robots that go from one motion to the next.
  std::vector<Locals> Alone(const Locals& s) const {
    std::vector<Locals> result;
    if (auto begin = Begin(s)) result.push_back(std::move(*begin));
    for (size_t r = 0; r < types.size(); ++r) {
      const auto step = [&](StateId to, bool moving) {
        Locals next = s;
        next[r] = {to, moving};
        result.push_back(std::move(next));
      };
      const auto* move = MoveOf(At(s, r));
      // A motion that may last no time can begin at any moment, unless the robot might hear something first;
      // one that takes time needs time to pass for the others, too.
      const bool idle = move != nullptr && move->first.label == "Idle()";
      const bool instant = idle && At(s, r).next.size() == 1;
      if (move != nullptr && (instant || (s[r].second && (idle || AllMove(s))))) step(move->second, true);
      // Choosing and saying so are one step; who is alone just chooses.
      for (const auto& [guard, to] : At(s, r).choice) {
        if (!Sends(types[r].states[to.index()])) step(to, s[r].second);
      }
    }
    return result;
  }

  // A robot that waits, idling if that is what it may do meanwhile, hears what comes first.
  std::optional<StateId> Heard(const Locals& s, size_t r, const Action& message) const {
    StateId at = s[r].first;
    for (int idle = 0; idle < 3; ++idle) {
      const LocalState& state = types[r].states[at.index()];
      if (const auto it = state.next.find(message); it != state.next.end()) return it->second;
      const auto* move = MoveOf(state);
      if (move == nullptr || move->first.label != "Idle()") break;
      at = move->second;
    }
    return std::nullopt;
  }

  // Messages that both ends are ready for.
  std::vector<std::pair<std::string, Locals>> Messages(const Locals& s) const {
    std::vector<std::pair<std::string, Locals>> result;
    for (size_t r = 0; r < types.size(); ++r) {
      std::vector<StateId> from{s[r].first};
      for (const auto& [guard, to] : At(s, r).choice) from.push_back(to);
      for (const StateId at : from) Say(s, r, types[r].states[at.index()], result);
    }
    return result;
  }

  void Say(const Locals& s, size_t r, const LocalState& state,
           std::vector<std::pair<std::string, Locals>>& result) const {
    for (const auto& [action, to] : state.next) {
      if (action.kind != Action::Kind::kSend) continue;
      const size_t peer = action.peer.index();
      const std::optional<StateId> heard = Heard(s, peer, {Action::Kind::kReceive, RobotId(r), action.label});
      if (!heard) continue;
      Locals next = s;
      next[r] = {to, false};
      next[peer] = {*heard, false};
      result.emplace_back(std::to_string(r) + ">" + std::to_string(peer) + ":" + action.label,
                          std::move(next));
    }
  }

  static bool Sends(const LocalState& state) {
    return std::ranges::any_of(state.next,
                               [](const auto& step) { return step.first.kind == Action::Kind::kSend; });
  }

  bool Ended(const Locals& s) const {
    for (size_t r = 0; r < types.size(); ++r) {
      if (!At(s, r).ends) return false;
    }
    return true;
  }
};

constexpr size_t kMostStates = 20'000;

// Empty if no reachable state is stuck.
std::string Stuck(const Team& team) {
  std::set<Locals> seen;
  std::vector<Locals> todo{Locals(team.types.size(), {StateId(0), false})};
  while (!todo.empty() && seen.size() < kMostStates) {
    const Locals s = std::move(todo.back());
    todo.pop_back();
    if (!seen.insert(s).second) continue;
    bool stuck = !team.Ended(s);
    for (Locals& next : team.Alone(s)) {
      stuck = false;
      todo.push_back(std::move(next));
    }
    for (auto& [message, next] : team.Messages(s)) {
      stuck = false;
      todo.push_back(std::move(next));
    }
    if (!stuck) continue;
    std::string where;
    for (const auto& [id, moving] : s) where += " " + std::to_string(id.value);
    return "stuck in" + where;
  }
  return "";
}

// The same message by all team states that are reached without others.
std::set<Locals> After(const Team& team, const std::set<Locals>& from, const std::string& message) {
  std::set<Locals> seen, result;
  std::vector<Locals> todo(from.begin(), from.end());
  while (!todo.empty()) {
    const Locals s = std::move(todo.back());
    todo.pop_back();
    if (!seen.insert(s).second) continue;
    for (Locals& next : team.Alone(s)) todo.push_back(std::move(next));
    for (auto& [said, next] : team.Messages(s)) {
      if (said == message) result.insert(std::move(next));
    }
  }
  return result;
}

// A random run of the whole: where its threads are.
class WholeRun {
 public:
  WholeRun(const Graph& graph, uint64_t seed) : graph_(graph), at_{graph.start}, rng_(seed) {}

  // The next message; empty at the end, or after many other steps.
  std::string Next() {
    for (int i = 0; i < 200 && !at_.empty(); ++i) {
      const size_t k = static_cast<size_t>(rng_() % at_.size());
      const NodeId id = at_[k];
      const Node& n = graph_[id];
      switch (n.kind) {
        case NodeKind::kMessage:
          at_[k] = n.next[0];
          return std::to_string(n.from.value) + ">" + std::to_string(n.to.value) + ":" + n.label;
        case NodeKind::kMotion:
        case NodeKind::kMerge:
          at_[k] = n.next[0];
          break;
        case NodeKind::kChoice:
          at_[k] = n.next[rng_() % n.next.size()];
          break;
        case NodeKind::kFork:
          waiting_[n.join] = n.next.size();
          at_.erase(at_.begin() + static_cast<std::ptrdiff_t>(k));
          at_.insert(at_.end(), n.next.begin(), n.next.end());
          break;
        case NodeKind::kJoin:
          at_.erase(at_.begin() + static_cast<std::ptrdiff_t>(k));
          if (--waiting_[id] == 0) at_.push_back(n.next[0]);
          break;
        case NodeKind::kEnd:
          return "";
      }
    }
    return "";
  }

 private:
  const Graph& graph_;
  std::vector<NodeId> at_;
  std::map<NodeId, size_t> waiting_;
  std::mt19937_64 rng_;
};

TEST(Choreo, ProjectionsAgreeWithTheWhole) {
  int good = 0;
  int branching = 0;
  for (uint64_t seed = 0; seed < 30'000; ++seed) {
    const std::string text = Texts(seed).Whole();
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    Module module;
    expr::Arena arena;
    Parse(sources, sources.Add("random", text), module, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << text;
    Declarations declarations(module, arena, diagnostics);
    const std::vector<Graph> graphs = Lower(module, declarations);
    if (graphs.empty()) continue;
    CheckWellFormed(graphs[0], diagnostics);
    if (diagnostics.has_errors()) continue;
    Team team{graphs[0], {}};
    for (size_t r = 0; r < graphs[0].robots.size(); ++r)
      team.types.push_back(Project(graphs[0], module.exprs, RobotId(r), diagnostics));
    if (diagnostics.has_errors()) continue;
    ++good;
    branching += text.find("choose") != std::string::npos ? 1 : 0;
    ASSERT_EQ(Stuck(team), "") << "seed " << seed << "\n" << text;
    for (uint64_t run = 0; run < 3; ++run) {
      WholeRun whole(graphs[0], run);
      std::set<Locals> states{Locals(team.types.size(), {StateId(0), false})};
      for (int i = 0; i < 8; ++i) {
        const std::string message = whole.Next();
        if (message.empty()) break;
        states = After(team, states, message);
        ASSERT_FALSE(states.empty()) << "seed " << seed << " at " << message << "\n" << text;
      }
    }
  }
  EXPECT_GT(good, 300);
  EXPECT_GT(branching, 30);
}

}  // namespace
}  // namespace rondo::choreo
