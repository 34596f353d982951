#include "sim/campaign/scenario.h"

#include <iterator>
#include <random>

namespace rondo::sim::campaign {

using runtime::rounds::OnLoss;

Scenario Draw(uint64_t seed, size_t least, size_t most) {
  // Not the numbers that the network draws.
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15 + 0x5ce0a210);
  const auto below = [&](uint64_t n) { return random() % n; };
  Scenario s;
  s.seed = seed;
  s.robots = least + below(most - least + 1);
  // With two robots there is no majority without the other.
  s.on_loss = static_cast<OnLoss>(below(s.robots == 2 ? 2 : 3));
  s.disks = below(2) == 0;
  const Time time = s.delta * static_cast<Time>(s.rounds) * 2 / 3;
  // Every third run is a storm: lives that are short, and datagrams that outlive them, from some moment on (the
  // beginning of the session, half of the time).
  const bool storm = below(3) == 0;
  const Time from = storm && below(2) == 0 ? static_cast<Time>(below(static_cast<uint64_t>(time))) : 0;
  const size_t count = below(9);
  if (storm) {
    s.faults.push_back(
        {FaultKind::kDelay, from, 800'000'000, 0, 0, static_cast<double>(below(100) + 1) / 1000});
    s.faults.push_back({FaultKind::kDuplicate, from, 800'000'000, 0, 0, 0.5});
  }
  for (size_t i = 0; i < count; ++i) {
    Fault f;
    constexpr FaultKind kLives[] = {FaultKind::kCrash, FaultKind::kForget, FaultKind::kPause,
                                    FaultKind::kDiskFull};
    f.kind = storm ? kLives[below(std::size(kLives))]
                   : static_cast<FaultKind>(below(static_cast<uint64_t>(FaultKind::kDiskFull) + 1));
    f.at = storm ? from + static_cast<Time>(below(700'000'000))
                 : static_cast<Time>(below(static_cast<uint64_t>(time)));
    const uint64_t longest = storm ? 60'000'000 : below(2) == 0 ? 200'000'000 : 2'000'000'000;
    f.length = static_cast<Time>(10'000'000 + below(longest));
    f.robot = static_cast<uint32_t>(below(s.robots));
    f.other = s.robots == 1 ? 0 : static_cast<uint32_t>((f.robot + 1 + below(s.robots - 1)) % s.robots);
    f.amount = static_cast<double>(below(50) + 1) / 100;
    if (f.kind == FaultKind::kDelay) f.amount /= below(2) == 0 ? 1 : 10;
    s.faults.push_back(f);
  }
  return s;
}

}  // namespace rondo::sim::campaign
