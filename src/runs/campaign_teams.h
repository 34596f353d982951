#pragma once

#include <memory>
#include <vector>

#include "koord/native/native_program.h"
#include "sim/campaign/any_functions.h"
#include "sim/campaign/world.h"
#include "sim/fleet/fleet.h"

/// Compiles the teams of campaigns.
namespace rondo::runs {

/// Makes teams of one program: parameters from the fleet, external functions that give anything.
class CampaignTeams {
 public:
  /// @param model, fleet  outlive this, and this outlives its teams.
  CampaignTeams(const koord::Model& model, const sim::Fleet& fleet) : model_(model), fleet_(fleet) {}

  /// Returns a team of this size; nullptr, with the reasons reported, if there is none.
  std::unique_ptr<koord::semantics::Team> Make(size_t robots, diag::Diagnostics& diagnostics);
  /// Makes teams as `Make` does, of sizes for which that has worked. `Native`: their events are run by a library, to which such a
  /// team could be attached.
  sim::campaign::Fleet::MakeTeam Maker();
  sim::campaign::Fleet::MakeTeam NativeMaker(const koord::native::Library& library,
                                             const diag::SourceSet& sources);

 private:
  const koord::Model& model_;
  const sim::Fleet& fleet_;
  std::vector<std::unique_ptr<sim::campaign::AnyFunctions>> hosts_;
  diag::Diagnostics again_;  // the same for every size
};

}  // namespace rondo::runs
