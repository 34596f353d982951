#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <span>

/// Search over any transition system whose states are sequences of words, all of one length.
namespace rondo::explore {

using Word = uint64_t;

enum class Seen : uint8_t {
  kKnown,  ///< visited before
  kNew,
  kStop,  ///< do not go on
};
using Visit = std::function<Seen(std::span<const Word>)>;

/// What a system found while it listed states. `property` counts from 0; negative: nothing is wrong.
struct Broken {
  int property = -1;
  /// The state that was visited last breaks it; else something on the way from the state whose successors
  /// were asked for.
  bool at_visited = false;
};

/// The system calls `visit` for each initial state, or each successor, checks its properties on those that
/// are new, and ends early when one is broken or `visit` says so. It must list the same states in the same
/// order each time.
template <typename S>
concept TransitionSystem = requires(S& system, std::span<const Word> state, const Visit& visit) {
  { system.words() } -> std::convertible_to<size_t>;
  { system.Initial(visit) } -> std::same_as<Broken>;
  { system.Successors(state, visit) } -> std::same_as<Broken>;
  /// Nothing will ever change, and that is not an end that the system declares.
  { system.Deadlocked(state) } -> std::same_as<bool>;
};

}  // namespace rondo::explore
