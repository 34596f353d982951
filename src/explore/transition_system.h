#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <span>

/// Search over any transition system whose states are sequences of words, all of one length.
namespace rondo::explore {

/// Is one part of a state; what it means is up to the system.
using Word = uint64_t;

/// Tells a system what became of a state that it listed.
enum class Seen : uint8_t {
  kKnown,  ///< visited before: its properties need no check
  kNew,    ///< met for the first time: the system checks its properties
  kStop,   ///< the search is over: the system lists no more
};
/// Is called by a system with each state that it lists; the words are read during the call only.
using Visit = std::function<Seen(std::span<const Word>)>;

/// Tells what a system found while it listed states.
struct Broken {
  int property = -1;  ///< which property is broken, from 0; negative: nothing is wrong
  /// True if the state that was visited last breaks it; else something on the way from the state whose
  /// successors were asked for does.
  bool at_visited = false;
};

/// Is what `Search` can explore. The system calls `visit` for each initial state, or each successor, checks
/// its properties on those that are new, and ends early when one is broken or `visit` says so. It must list
/// the same states in the same order each time, because counterexamples are found again from their numbers.
template <typename S>
concept TransitionSystem = requires(S& system, std::span<const Word> state, const Visit& visit) {
  { system.words() } -> std::convertible_to<size_t>;
  { system.Initial(visit) } -> std::same_as<Broken>;
  { system.Successors(state, visit) } -> std::same_as<Broken>;
  /// Reports whether nothing will ever change from here, though that is not an end that the system declares.
  { system.Deadlocked(state) } -> std::same_as<bool>;
};

}  // namespace rondo::explore
