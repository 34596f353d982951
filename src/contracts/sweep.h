#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "contracts/decide.h"

/// Finds out for which values of a parameter a contract holds.
namespace rondo::contracts {

/// Tells what is known for one part of the range of a parameter: the parameter is an unknown constant of the
/// problem, and its range is halved until each part is proved, or short.
struct SweepPart {
  double from = 0, to = 0;
  /// Holds what is known: kProved for every value, kRefuted for one of them, kUnknown.
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  double counterexample = 0;  ///< the value of a trajectory that breaks the contract, if refuted
  std::string claim;          ///< the claim that fails
  bool certified = false;     ///< the proof was certified, for all of the part
};

/// Holds what is known for the whole range of a parameter.
struct Sweep {
  std::string contract, parameter;
  std::string trouble = {};  ///< why there is no answer, if there is none
  bool out_of_time = false;  ///< more time would decide more
  bool stopped = false;      ///< somebody stopped it before its end
  /// Holds the parts, ascending; neighbours differ in their verdict, or in being certified.
  std::vector<SweepPart> parts = {};
};

/// Decides the contract for parts of the range of the parameter: wide parts first, hard ones last.
/// @param parts  how many parts of the range, at most, are told apart: a power of two.
Sweep SweepContract(const ContractResult& contract, const std::string& parameter, size_t parts,
                    const DecideOptions& options, const base::StopToken& stop);

/// Returns the sweep as text for people, and as JSON.
std::string ToText(const Sweep& sweep);
nlohmann::json ToJson(const Sweep& sweep);
/// Returns the verdict for the whole range.
verdict::Verdict VerdictOf(const Sweep& sweep);

}  // namespace rondo::contracts
