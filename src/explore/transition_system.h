#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// Search over any transition system whose states are sequences of bytes.
namespace rondo::explore {

/// Is one state as a system writes it. Equal states have equal bytes, whichever of the systems of a search
/// wrote them; what they mean is up to the system.
using State = std::span<const uint8_t>;
/// Is a state that somebody keeps.
using KeptState = std::vector<uint8_t>;

/// Is called by a system with each state that it lists; the bytes are read during the call only. Returns
/// false if the system should list no more.
using Visit = std::function<bool(State)>;

/// Tells what a system found while it listed states.
struct Broken {
  int property = -1;  ///< which property is broken, from 0; negative: nothing is wrong
  /// True if the state that was listed last breaks it; else something on the way from the state whose
  /// successors were asked for does.
  bool at_visited = false;
};

/// Is what `Search` can explore. The system calls `visit` for each initial state, or each successor, and ends
/// early when something on the way is broken or `visit` says so; `Check` looks at the states themselves. It
/// must list the same states in the same order each time, because counterexamples are found again from their
/// numbers. One system serves one thread. What `Marks` returns is counted over the states whose successors were
/// listed.
template <typename S>
concept TransitionSystem = requires(S& system, State state, const Visit& visit) {
  { system.Initial(visit) } -> std::same_as<Broken>;
  { system.Successors(state, visit) } -> std::same_as<Broken>;
  /// Returns which property the state breaks; negative: none.
  { system.Check(state) } -> std::same_as<int>;
  /// Returns bits that say what was met when the successors of a state were listed last; always as many words.
  { system.Marks() } -> std::convertible_to<std::span<const uint64_t>>;
  /// Reports whether nothing will ever change from here, though that is not an end that the system declares.
  { system.Deadlocked(state) } -> std::same_as<bool>;
};

}  // namespace rondo::explore
