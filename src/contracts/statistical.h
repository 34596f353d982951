#pragma once

#include "contracts/contract.h"

/// Estimates by runs how often a contract fails.
namespace rondo::contracts {

/// Says how many runs there are, and what they look at.
struct StatisticalOptions {
  size_t runs = 6905;         ///< that must not fail
  double confidence = 0.999;  ///< how certain the bound has to be
  uint64_t seed = 1;
  unsigned jobs = 0;
  double dt = 0.02;       ///< seconds between the instants that are looked at
  std::string simulator;  ///< a command or a shared library (`.so`); empty: the model itself
  std::string tube;  ///< `careful` or `compat`: judge a tube that is learned from runs; empty: the contract
};

/// Holds what samples say about one contract: never a proof.
struct Statistical {
  std::string trouble;  ///< why there is no answer, if there is none
  size_t runs = 0, failures = 0;
  double epsilon = 1, confidence = 0;       ///< a failure has at most this probability
  size_t corners = 0, corner_failures = 0;  ///< from corners of the initial box: no probability
  std::vector<double> worst;  ///< a start from which a run failed, by state; empty if there is none
  interval::Box final;        ///< of the tube, if one is judged
  double seconds = 0;
};

/// Draws starts uniformly from the initial box (those that `pre` excludes count as good), inputs at random,
/// and looks at the claims every `dt` seconds, or a little less. Bounds the probability of a failure (Clopper
/// and Pearson), and tries corners of the box as well.
Statistical Sample(const ContractResult& contract, const StatisticalOptions& options,
                   const base::StopToken& stop);

/// Returns the result as a line of text, and as JSON.
std::string StatisticalLine(const ContractResult& contract, const Statistical& s);
nlohmann::json ToJson(const ContractResult& contract, const Statistical& s,
                      const StatisticalOptions& options);

}  // namespace rondo::contracts
