#include "sim/campaign/scenario.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <random>

#include "base/mixed.h"

namespace rondo::sim::campaign {

using runtime::rounds::Exchange;
using runtime::rounds::OnLoss;

namespace {

// A majority without one of its robots may know something that the others must not decide without. So: while some are not
// heard, the others go on; then one of these crashes, and comes back while those who were heard with it are not heard.
void Conspire(Scenario& s, std::mt19937_64& random) {
  const auto below = [&](uint64_t n) { return random() % n; };
  s.on_loss = OnLoss::kEvict;
  s.disks = below(4) != 0;
  std::vector<uint32_t> robots(s.robots);
  std::iota(robots.begin(), robots.end(), 0);
  std::shuffle(robots.begin(), robots.end(), random);
  const size_t majority = s.robots / 2 + 1;
  // From the beginning of the session, or when it goes on without those who are not heard.
  const bool first = below(3) == 0;
  const Time from = first ? 0 : static_cast<Time>(below(600'000'000));
  const Time crash =
      from + (first || below(2) == 0 ? static_cast<Time>(below(60'000'000))
                                     : s.patience + s.lease + static_cast<Time>(below(400'000'000)));
  const Time back = crash + static_cast<Time>(below(40'000'000));
  const Time end = back + 700'000'000 + static_cast<Time>(below(700'000'000));
  for (size_t i = 0; i < s.robots; ++i) {
    Fault fault;
    fault.robot = robots[i];
    if (i == 0) {
      fault.kind = s.disks ? FaultKind::kCrash : FaultKind::kForget;
      fault.at = crash;
      fault.length = back - crash + 1'000'000;
      if (s.disks && below(2) == 0)
        s.faults.push_back({FaultKind::kDiskFull, from, crash - from, robots[i], 0, 0});
    } else {
      fault.kind = FaultKind::kAlone;
      fault.at = i < majority ? crash : from;
      fault.length = i < majority ? end - crash : back - from;
    }
    s.faults.push_back(fault);
  }
}

}  // namespace

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
  // Half of the runs over one robot, without a change to what else happens in them.
  const uint64_t way = base::Mixed(seed) % 4;
  if (way > 1) s.exchange = way == 2 ? Exchange::kSequencer : Exchange::kCentral;
  const Time time = s.delta * static_cast<Time>(s.rounds) * 2 / 3;
  if (s.robots >= 3 && below(6) == 0) {
    Conspire(s, random);
    return s;
  }
  // Every third of the others is a storm: lives that are short, and datagrams that outlive them, from some moment on (the
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
    f.kind = storm ? kLives[below(std::size(kLives))] : static_cast<FaultKind>(below(cores::kFaultKinds));
    f.at = storm ? from + static_cast<Time>(below(700'000'000))
                 : static_cast<Time>(below(static_cast<uint64_t>(time)));
    const uint64_t longest = storm ? 60'000'000 : below(2) == 0 ? 200'000'000 : 2'000'000'000;
    f.length = static_cast<Time>(10'000'000 + below(longest));
    f.robot = static_cast<uint32_t>(below(s.robots));
    f.other = s.robots == 1 ? 0 : static_cast<uint32_t>((f.robot + 1 + below(s.robots - 1)) % s.robots);
    f.amount = static_cast<double>(below(50) + 1) / 100;
    if (f.kind == FaultKind::kSlow) f.amount /= 50;
    if (f.kind == FaultKind::kClock) f.amount = (below(2) == 0 ? -1 : 1) * 1000 * f.amount;
    if (f.kind == FaultKind::kDelay) f.amount /= below(2) == 0 ? 1 : 10;
    s.faults.push_back(f);
  }
  return s;
}

}  // namespace rondo::sim::campaign
