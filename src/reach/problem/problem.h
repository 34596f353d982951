#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reach/problem/program.h"

/// What reachability is asked: dynamics, controller, events, starts and claims. Engines, checker and
/// simulators agree on nothing but this.
namespace rondo::reach {

/// Is something that happens at the instants 0, period, 2 period, ... before the horizon: the states take new
/// values, all at once, that are computed from the old ones. Between these instants they follow their rates.
struct Controller {
  Rational period;  ///< seconds
  /// By state; a state without a value keeps its own.
  std::vector<std::optional<TermId>> updates;
};

/// Is an input that changes at any time, in any way (measurably), within its bounds. A controller reads the
/// value that it happens to have at that instant.
struct Input {
  TermId term;
  Interval bounds;
};

/// Is something that happens as soon as its condition holds: discrete states take new values, all at once.
/// What events set are discrete states: their rates are zero, they have one value at the start, and what they
/// are set to depends on discrete states only.
///
/// An event happens at the first instant at which its condition begins to hold for some time (the infimum, if
/// there is no first one); other events may follow at the same instant. Where a condition holds for a single
/// instant only, its event may happen or not.
struct Event {
  TermId condition;
  /// By state; a state without a value keeps its own.
  std::vector<std::optional<TermId>> updates;
};

/// Is what must hold at every instant of [from, to], in seconds.
struct Claim {
  std::string name;
  TermId formula;
  Rational from, to;
};

/// States a controlled system, where it may start, and what must hold along every trajectory that it can
/// take.
///
/// Times are in seconds. `initial` encloses what `assume` allows; the claims must hold for the starts that
/// satisfy both.
struct Problem {
  std::string name;
  expr::Arena* arena = nullptr;
  std::vector<TermId> states;
  std::vector<TermId> rates;  ///< x' by state, per second
  std::vector<Input> inputs;
  std::optional<Controller> controller;
  std::vector<Event> events;
  interval::Box initial;
  /// By state: its exact value at the start, where there is only one. Empty: none is known.
  std::vector<std::optional<Rational>> pinned;
  /// By state: the state whose initial value it has, too, if there is one. Empty: none has.
  std::vector<std::optional<size_t>> copy_of;
  /// What every start satisfies: a formula over the states at time 0.
  TermId assume;
  Rational horizon;  ///< seconds; nothing is claimed beyond
  std::vector<Claim> claims;
};

/// Returns what each state is after the controller has acted.
inline std::vector<TermId> Updated(const Problem& problem) {
  std::vector<TermId> values = problem.states;
  for (size_t i = 0; problem.controller && i < values.size(); ++i)
    values[i] = problem.controller->updates[i].value_or(values[i]);
  return values;
}

/// Returns how often the controller acts before the horizon.
inline size_t Samples(const Problem& problem) {
  if (!problem.controller) return 0;
  const Rational count = problem.horizon / problem.controller->period;
  const Rational whole = count.Floor();
  return static_cast<size_t>(whole.ToDouble()) + (whole == count ? 0 : 1);
}

}  // namespace rondo::reach
