#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "contracts/decide.h"

namespace rondo::contracts {

/// Which values of a parameter a contract holds for: the parameter is an unknown constant of the problem, and
/// its range is halved until each part is proved, or short.
struct SweepPart {
  double from = 0, to = 0;
  /// kProved for every value, kRefuted for one of them, kUnknown.
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
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
/// Returns that of the whole range.
verdict::Verdict VerdictOf(const Sweep& sweep);

}  // namespace rondo::contracts
