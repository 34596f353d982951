#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "contracts/load.h"

/// Shares what files about a contract have in common: certificates, and trajectories that break it.
namespace rondo::contracts {

/// Says which contract of which files is meant.
struct ContractName {
  std::vector<std::string> files;  ///< robots and choreographies, or a Koord program
  std::string spec;                ///< the specification of the program; empty: beside it
  std::string contract;
};

/// Returns the name as JSON of this format, with the paths made absolute.
nlohmann::json ContractToJson(const char* format, const ContractName& name);
/// Reads such JSON; returns nothing if something is missing.
std::optional<ContractName> ContractFromJson(const nlohmann::json& json);
/// Reports whether this is an object with that `format`.
bool HasFormat(const nlohmann::json& json, const char* format);

/// Reads the files and finds the contract.
///
/// @error if the files cannot be used, or have no such contract; what is wrong with them is in the session.
base::Result<const ContractResult*> FindContract(const ContractName& name, workspace::Session& session,
                                                 LoadedContracts& loaded);

}  // namespace rondo::contracts
