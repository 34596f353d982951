#pragma once

#include <functional>

#include "base/stop.h"
#include "contracts/contract.h"

/// Decides contracts.
namespace rondo::contracts {

/// Says how a contract is decided.
struct DecideOptions {
  double timeout = 60;                           ///< seconds for each contract
  unsigned jobs = 0;                             ///< threads; 0: one for each core
  uint64_t seed = 1;                             ///< of the trajectories that look for a violation
  bool certify = true;                           ///< of sweeps: have what is proved checked
  std::function<void(size_t, size_t)> progress;  ///< parts of the initial set that are proved, and open
  /// Of sweeps: called with the share of the range that is decided, and the part that is looked at next.
  std::function<void(double share, double from, double to)> swept = {};
};

/// Decides one contract by reachability; its outcome, or why it is impossible, goes into the result.
void DecideContract(ContractResult& result, const DecideOptions& options, const base::StopToken& stop);

}  // namespace rondo::contracts
