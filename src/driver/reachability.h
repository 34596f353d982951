#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "driver/motion.h"
#include "reach/validated/prover.h"
#include "robot/reach/motion_problem.h"

namespace rondo::driver {

/// One contract, and what became of it.
struct ContractResult {
  robot::MotionProblem made;
  diag::Span span;                         ///< of the motion
  std::string impossible;                  ///< why there is no problem to decide, if there is none
  std::optional<size_t> same_as;           ///< the same problem as an earlier one, up to symmetry
  std::optional<reach::Outcome> outcome;   ///< nothing: not begun
  double seconds = 0;
};

/// The contracts of the motions that choreographies use; without any, of all robot types, as far as they have
/// controllers or dynamics and their parameters have values or ranges.
std::vector<ContractResult> ContractsOf(Motion& motion, Session& session);

int StatusOf(const ContractResult& result);
std::string_view VerdictOf(const ContractResult& result);
/// Reports what is refuted or open.
void ReportContract(const ContractResult& result, diag::Diagnostics& diagnostics);
std::string ContractTable(const std::vector<ContractResult>& results);
nlohmann::json ToJson(const ContractResult& result);

}  // namespace rondo::driver
