#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "contracts/contract.h"
#include "diag/diagnostic.h"

namespace rondo::contracts {

/// Reports what is refuted or open: where, by how much, from which start.
void ReportContract(const ContractResult& result, diag::Diagnostics& diagnostics);

/// A line for each contract: verdict, seconds, seconds of the checker, parts.
std::string ContractTable(const std::vector<ContractResult>& results);

nlohmann::json ToJson(const ContractResult& result);

}  // namespace rondo::contracts
