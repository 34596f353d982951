#pragma once

#include <vector>

#include "runtime/rounds/settings.h"
#include "sim/cores/fault.h"

/// What goes wrong in a run of a campaign.
namespace rondo::sim::campaign {

using cores::Fault;
using cores::FaultKind;
using cores::Time;

/// Holds everything that decides a run.
struct Scenario {
  uint64_t seed = 1;
  size_t robots = 3;
  uint64_t rounds = 30;  ///< after which a run ends
  runtime::rounds::OnLoss on_loss = runtime::rounds::OnLoss::kWait;
  runtime::rounds::Exchange exchange = runtime::rounds::Exchange::kAllToAll;
  bool disks = false;
  Time delta = 100'000'000;
  Time lease = 400'000'000;
  Time stop_time = 50'000'000;
  Time patience = 300'000'000;
  std::vector<Fault> faults;
};

/// Makes a scenario from a number: size, policy, exchange, disks and up to eight faults in the time of its first
/// rounds. The same number gives the same scenario.
/// @param least, most  how many robots there may be.
Scenario Draw(uint64_t seed, size_t least, size_t most);

}  // namespace rondo::sim::campaign
