#pragma once

#include "koord/semantics/responses.h"
#include "koord/semantics/system.h"

namespace rondo::koord::semantics {

/// Presents a team together with how long its robots have waited for what has to follow within some rounds: states of
/// `System`, without symmetry, and behind them the words of `Responses`. The responses are properties behind those of the
/// system, in order.
class TimedSystem {
 public:
  TimedSystem(System& system, Team& team);

  size_t words() const { return system_.words() + responses_.words(); }
  explore::Broken Initial(const explore::Visit& visit);
  explore::Broken Successors(std::span<const Word> packed, const explore::Visit& visit);
  bool Deadlocked(std::span<const Word> packed) { return system_.Deadlocked(packed.first(system_.words())); }

  /// Returns which response a broken property is; nothing if it is one of the system's.
  std::optional<size_t> ResponseOf(int property) const;
  const Responses& responses() const { return responses_; }
  /// Returns the part of each state that the system knows.
  std::vector<std::vector<Word>> OfSystem(const std::vector<std::vector<Word>>& path) const;

 private:
  // Visits a state of the system with the waits that lead to it.
  explore::Seen Extend(std::span<const Word> packed, std::span<const Word> before,
                       const explore::Visit& visit);

  System& system_;
  Responses responses_;
  int first_;  // the number of the first response
  int late_ = -1;
  std::vector<Word> extended_;
};

static_assert(explore::TransitionSystem<TimedSystem>);

}  // namespace rondo::koord::semantics
