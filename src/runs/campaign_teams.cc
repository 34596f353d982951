#include "runs/campaign_teams.h"

#include "sim/parameters.h"

namespace rondo::runs {

std::unique_ptr<koord::semantics::Team> CampaignTeams::Make(size_t robots, diag::Diagnostics& diagnostics) {
  koord::semantics::TeamOptions options;
  options.robots = robots;
  options.hosted = [](size_t) { return true; };
  koord::semantics::Heap heap;
  sim::ReadParameters(model_, fleet_, options, heap, diagnostics);
  auto team = koord::semantics::Team::Make(model_, options, diagnostics, std::move(heap));
  if (team == nullptr) return team;
  hosts_.push_back(std::make_unique<sim::campaign::AnyFunctions>(*team));
  team->machine().SetHost(hosts_.back().get());
  return team;
}

sim::campaign::Fleet::MakeTeam CampaignTeams::Maker() {
  return [this](size_t robots) { return Make(robots, again_); };
}

sim::campaign::Fleet::MakeTeam CampaignTeams::NativeMaker(const koord::native::Library& library,
                                                          const diag::SourceSet& sources) {
  return [this, &library, &sources](size_t robots) {
    auto team = Make(robots, again_);
    if (team != nullptr) (void)library.Attach(*team, sources).ok();
    return team;
  };
}

}  // namespace rondo::runs
