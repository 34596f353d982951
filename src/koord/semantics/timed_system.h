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

  explore::Broken Initial(const explore::Visit& visit);
  explore::Broken Successors(explore::State packed, const explore::Visit& visit);
  int Check(explore::State packed);
  std::span<const uint64_t> Marks() const { return system_.Marks(); }
  bool Deadlocked(explore::State packed) { return system_.Deadlocked(OfSystem(packed)); }

  /// Returns which response a broken property is; nothing if it is one of the system's.
  std::optional<size_t> ResponseOf(int property) const;
  const Responses& responses() const { return responses_; }
  /// Returns the part of each state that the system knows.
  std::vector<explore::KeptState> OfSystem(const std::vector<explore::KeptState>& path) const;

 private:
  // Visits a state of the system with the waits that lead to it.
  bool Extend(explore::State packed, std::span<const Word> before, const explore::Visit& visit);
  explore::State OfSystem(explore::State packed) const {
    return packed.first(packed.size() - responses_.words() * sizeof(Word));
  }
  std::vector<Word> WaitsOf(explore::State packed) const;

  System& system_;
  Responses responses_;
  int first_;  // the number of the first response
  std::vector<Word> waits_;
  explore::KeptState extended_;
};

static_assert(explore::TransitionSystem<TimedSystem>);

}  // namespace rondo::koord::semantics
