#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// Searches transition systems of robots exhaustively, and compares what they say. A System has `State`,
/// `Start`, `Next` and `Ended`, as Team and Whole do.
namespace rondo::choreo {

/// Holds what an exhaustive search found.
struct SearchResult {
  bool stuck = false;
  std::vector<std::string> run;  ///< the messages of a shortest run into a state where nothing can happen
  size_t states = 0;
  bool complete = true;  ///< false: there are more states than were allowed; the rest was not looked at
};

/// Looks for a reachable state that has not ended and in which nothing can happen, breadth first, and gives
/// up beyond `most_states`.
template <typename System>
SearchResult FindStuck(const System& system, size_t most_states) {
  using State = typename System::State;
  SearchResult result;
  std::map<State, std::pair<const State*, std::string>> seen;  // how each state was reached
  std::vector<const State*> level;
  const auto reach = [&](State state, const State* from, std::string label, std::vector<const State*>& to) {
    const auto [it, fresh] = seen.emplace(std::move(state), std::pair(from, std::move(label)));
    if (fresh) to.push_back(&it->first);
  };
  reach(system.Start(), nullptr, "", level);
  while (!level.empty()) {
    std::vector<const State*> next;
    for (const State* state : level) {
      auto steps = system.Next(*state);
      if (steps.empty() && !system.Ended(*state)) {
        result.stuck = true;
        result.states = seen.size();
        for (const State* s = state; s != nullptr;) {
          const auto& [from, label] = seen.at(*s);
          if (!label.empty()) result.run.insert(result.run.begin(), label);
          s = from;
        }
        return result;
      }
      if (seen.size() > most_states) {
        result.complete = false;
        result.states = seen.size();
        return result;
      }
      for (auto& step : steps) reach(std::move(step.state), state, std::move(step.label), next);
    }
    level = std::move(next);
  }
  result.states = seen.size();
  return result;
}

/// Returns all states that are reached from `from` without a message, itself included.
template <typename System>
std::set<typename System::State> Silently(const System& system,
                                          const std::set<typename System::State>& from) {
  std::set<typename System::State> seen;
  std::vector<typename System::State> todo(from.begin(), from.end());
  while (!todo.empty()) {
    auto state = std::move(todo.back());
    todo.pop_back();
    if (!seen.insert(state).second) continue;
    for (auto& step : system.Next(state)) {
      if (step.label.empty()) todo.push_back(std::move(step.state));
    }
  }
  return seen;
}

/// Returns, by message that is possible in one of the states, the states right behind it.
template <typename System>
std::map<std::string, std::set<typename System::State>> Heard(
    const System& system, const std::set<typename System::State>& states) {
  std::map<std::string, std::set<typename System::State>> heard;
  for (const auto& state : states) {
    for (auto& step : system.Next(state)) {
      if (!step.label.empty()) heard[step.label].insert(std::move(step.state));
    }
  }
  return heard;
}

/// Returns a shortest sequence of messages that one system allows and the other does not, with a last entry
/// that says which one does. Empty if both allow the same, as far as `most_pairs` sets of states show. Cost:
/// exponential in the number of states at worst (subset construction).
template <typename A, typename B>
std::vector<std::string> DifferentTrace(const A& a, const B& b, size_t most_pairs) {
  using Sets = std::pair<std::set<typename A::State>, std::set<typename B::State>>;
  std::set<Sets> seen;
  std::vector<std::pair<Sets, std::vector<std::string>>> level;
  level.push_back({{Silently(a, {a.Start()}), Silently(b, {b.Start()})}, {}});
  while (!level.empty()) {
    std::vector<std::pair<Sets, std::vector<std::string>>> next;
    for (auto& [sets, run] : level) {
      if (!seen.insert(sets).second || seen.size() > most_pairs) continue;
      const auto heard_a = Heard(a, sets.first);
      const auto heard_b = Heard(b, sets.second);
      for (const auto& [label, states] : heard_a) {
        std::vector<std::string> longer = run;
        longer.push_back(label);
        const auto other = heard_b.find(label);
        if (other == heard_b.end()) {
          longer.emplace_back("only the first");
          return longer;
        }
        next.push_back({{Silently(a, states), Silently(b, other->second)}, std::move(longer)});
      }
      for (const auto& [label, states] : heard_b) {
        if (heard_a.contains(label)) continue;
        run.push_back(label);
        run.emplace_back("only the second");
        return run;
      }
    }
    level = std::move(next);
  }
  return {};
}

}  // namespace rondo::choreo
