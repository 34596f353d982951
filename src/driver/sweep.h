#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "driver/reachability.h"

namespace rondo::driver {

/// Which values of a parameter a contract holds for: the parameter is an unknown constant of the problem, and
/// its range is halved until each part is proved, or short.
struct SweepPart {
  double from = 0, to = 0;
  std::string verdict;        ///< proved (for every value), refuted (for one of them), unknown
  double counterexample = 0;  ///< the value of a trajectory that breaks the contract, if refuted
  std::string claim;          ///< that fails
  bool certified = false;     ///< of a proof: for all of the part
};

struct Sweep {
  std::string contract, parameter;
  std::string trouble;           ///< why there is no answer, if there is none
  bool out_of_time = false;      ///< more time would decide more
  std::vector<SweepPart> parts;  ///< ascending; neighbours differ in their verdict, or in being certified
};

/// @param parts  how many parts of the range, at most, are told apart: a power of two.
Sweep SweepContract(const ContractResult& contract, const std::string& parameter, size_t parts,
                    const DecideOptions& options, const base::StopToken& stop);

std::string ToText(const Sweep& sweep);
nlohmann::json ToJson(const Sweep& sweep);
int StatusOf(const Sweep& sweep);

}  // namespace rondo::driver
