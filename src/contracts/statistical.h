#pragma once

#include "contracts/contract.h"

namespace rondo::contracts {

struct StatisticalOptions {
  size_t runs = 6905;  ///< that must not fail
  double confidence = 0.999;
  uint64_t seed = 1;
  unsigned jobs = 0;
  double dt = 0.02;       ///< seconds between the instants that are looked at
  std::string simulator;  ///< a command or a shared library (`.so`); empty: the model itself
  std::string tube;  ///< `careful` or `compat`: judge a tube that is learned from runs; empty: the contract
};

/// What samples say about one contract: never a proof.
struct Statistical {
  std::string trouble;  ///< why there is no answer, if there is none
  size_t runs = 0, failures = 0;
  double epsilon = 1, confidence = 0;
  size_t corners = 0, corner_failures = 0;
  std::vector<double> worst;
  interval::Box final;  ///< of the tube, if one is judged
  double seconds = 0;
};

/// Draws starts uniformly from the initial box (those that `pre` excludes count as good), inputs
/// at random, and looks at the claims every `dt`.
Statistical Sample(const ContractResult& contract, const StatisticalOptions& options,
                   const base::StopToken& stop);

std::string StatisticalLine(const ContractResult& contract, const Statistical& s);
nlohmann::json ToJson(const ContractResult& contract, const Statistical& s,
                      const StatisticalOptions& options);

}  // namespace rondo::contracts
