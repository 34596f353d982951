#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "contracts/contract.h"
#include "diag/diagnostic.h"

/// Reports what became of contracts.
namespace rondo::contracts {

/// Reports a contract that is refuted or open: where it fails, by how much, from which start.
void ReportContract(const ContractResult& result, diag::Diagnostics& diagnostics);

/// Returns a table with a line for each contract: verdict, seconds, seconds of the checker, parts of the
/// initial set.
std::string ContractTable(const std::vector<ContractResult>& results);

/// Returns a contract and what became of it as JSON.
nlohmann::json ToJson(const ContractResult& result);

}  // namespace rondo::contracts
