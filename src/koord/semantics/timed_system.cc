#include "koord/semantics/timed_system.h"

#include <algorithm>

namespace rondo::koord::semantics {

using explore::Broken;
using explore::Seen;
using explore::Visit;

TimedSystem::TimedSystem(System& system, Team& team)
    : system_(system),
      responses_(team),
      first_(static_cast<int>(team.invariants().size()) + 2),
      extended_(system.words() + responses_.words()) {}

Seen TimedSystem::Extend(std::span<const Word> packed, std::span<const Word> before, const Visit& visit) {
  const size_t words = system_.words();
  std::ranges::copy(packed, extended_.begin());
  std::ranges::copy(before, extended_.begin() + static_cast<ptrdiff_t>(words));
  int late = -1;
  if (system_.AtRound(packed))
    late = responses_.Observe(system_.Unpack(packed), std::span(extended_).subspan(words));
  const Seen seen = visit(extended_);
  if (seen != Seen::kNew || late < 0) return seen;
  late_ = late;
  return Seen::kStop;
}

Broken TimedSystem::Initial(const Visit& visit) {
  late_ = -1;
  const std::vector<Word> none(responses_.words());
  const Broken broken = system_.Initial([&](std::span<const Word> s) { return Extend(s, none, visit); });
  return late_ < 0 ? broken : Broken{first_ + late_, true};
}

Broken TimedSystem::Successors(std::span<const Word> packed, const Visit& visit) {
  late_ = -1;
  const std::vector<Word> waits(packed.begin() + static_cast<ptrdiff_t>(system_.words()), packed.end());
  const Broken broken = system_.Successors(packed.first(system_.words()),
                                           [&](std::span<const Word> s) { return Extend(s, waits, visit); });
  return late_ < 0 ? broken : Broken{first_ + late_, true};
}

std::optional<size_t> TimedSystem::ResponseOf(int property) const {
  return property < first_ ? std::nullopt : std::optional(static_cast<size_t>(property - first_));
}

std::vector<std::vector<Word>> TimedSystem::OfSystem(const std::vector<std::vector<Word>>& path) const {
  std::vector<std::vector<Word>> result;
  for (const std::vector<Word>& state : path)
    result.emplace_back(state.begin(), state.begin() + static_cast<ptrdiff_t>(system_.words()));
  return result;
}

}  // namespace rondo::koord::semantics
