#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "contracts/contract.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"

/// Finds the contracts that files contain.
namespace rondo::contracts {

/// Returns the contracts of the motions that choreographies use; without any, of all robot types, as far as
/// they have controllers or dynamics and their parameters have values or ranges.
/// @param reduce  use that places do not matter, where they do not.
/// @param keep  a parameter that stays nevertheless.
/// @param left_out  gets the motions of robot types that cannot be looked at alone, and why.
std::vector<ContractResult> ContractsOf(workspace::LoadedModule& module, bool reduce = true,
                                        std::string_view keep = "",
                                        std::vector<std::string>* left_out = nullptr);

/// Holds the models that the platforms of a Koord program name, read from their files.
struct Platforms {
  std::vector<std::unique_ptr<workspace::LoadedModule>> files;
  std::vector<std::unique_ptr<robot::World>> worlds;
};

/// Returns the controller assumptions of the program whose modules have a platform, as contracts.
/// @param platforms  gets the models; must outlive the result.
/// @param loose  a parameter of the program or of the models that may have any value between two bounds.
std::vector<ContractResult> PortContractsOf(const workspace::LoadedKoord& koord, Platforms& platforms,
                                            workspace::Session& session, const robot::Loose* loose = nullptr);

/// Holds files with contracts, and what they are about.
struct LoadedContracts {
  std::unique_ptr<workspace::LoadedKoord> koord;
  std::unique_ptr<workspace::LoadedModule> module;
  Platforms platforms;
  std::vector<ContractResult> results;
  std::vector<std::string> left_out;  ///< motions that cannot be looked at alone, and why
};

/// Loads the contracts of robots and choreographies (`.rondo`), or of one Koord program, into `loaded`.
/// Returns false after an error, which is in the session.
/// @param reduce  as for ContractsOf.
/// @param loose  is kept: a parameter that may have any value between two bounds.
bool LoadContracts(const std::vector<std::string>& files, const std::string& spec, const robot::Loose* loose,
                   bool reduce, workspace::Session& session, LoadedContracts& loaded);

}  // namespace rondo::contracts
