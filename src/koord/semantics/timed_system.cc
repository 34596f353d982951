#include "koord/semantics/timed_system.h"

#include <cstring>

namespace rondo::koord::semantics {

using explore::Broken;
using explore::KeptState;
using explore::State;
using explore::Visit;

TimedSystem::TimedSystem(System& system, Team& team)
    : system_(system), responses_(team), first_(static_cast<int>(team.invariants().size()) + 2) {}

std::vector<Word> TimedSystem::WaitsOf(State packed) const {
  std::vector<Word> waits(responses_.words());
  std::memcpy(waits.data(), packed.data() + OfSystem(packed).size(), waits.size() * sizeof(Word));
  return waits;
}

bool TimedSystem::Extend(State packed, std::span<const Word> before, const Visit& visit) {
  extended_.assign(packed.begin(), packed.end());
  waits_.assign(before.begin(), before.end());
  if (system_.AtRound(packed)) responses_.Observe(system_.Unpack(packed), waits_);
  extended_.resize(packed.size() + waits_.size() * sizeof(Word));
  std::memcpy(extended_.data() + packed.size(), waits_.data(), waits_.size() * sizeof(Word));
  return visit(extended_);
}

Broken TimedSystem::Initial(const Visit& visit) {
  const std::vector<Word> none(responses_.words());
  return system_.Initial([&](State s) { return Extend(s, none, visit); });
}

Broken TimedSystem::Successors(State packed, const Visit& visit) {
  const std::vector<Word> waits = WaitsOf(packed);
  return system_.Successors(OfSystem(packed), [&](State s) { return Extend(s, waits, visit); });
}

int TimedSystem::Check(State packed) {
  const int late = responses_.Late(WaitsOf(packed));
  return late >= 0 ? first_ + late : system_.Check(OfSystem(packed));
}

std::optional<size_t> TimedSystem::ResponseOf(int property) const {
  return property < first_ ? std::nullopt : std::optional(static_cast<size_t>(property - first_));
}

std::vector<KeptState> TimedSystem::OfSystem(const std::vector<KeptState>& path) const {
  std::vector<KeptState> result;
  for (const KeptState& state : path) {
    const State kept = OfSystem(state);
    result.emplace_back(kept.begin(), kept.end());
  }
  return result;
}

}  // namespace rondo::koord::semantics
