#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/stop.h"
#include "history/judge.h"
#include "sim/campaign/world.h"

/// Looks for runs in which a fleet does not keep what the round protocol promises.
namespace rondo::sim::campaign {

struct Trial;

/// Says how many runs to make, of what.
struct CampaignOptions {
  uint64_t runs = 1000;
  uint64_t seed = 1;  ///< of the first run; the next ones count up
  size_t least = 2;   ///< robots
  size_t most = 7;
  uint64_t rounds = 30;             ///< of each run
  std::vector<Scenario> scenarios;  ///< if there are any, these instead of drawn ones
  bool shrink = true;
  /// Receives how many runs are done, now and then.
  std::function<void(uint64_t)> progress;
  /// Receives each run, and the team that judged it.
  std::function<void(const Trial&, koord::semantics::Team&)> each;
  base::StopToken stop;
};

/// Is a run that was made twice, and judged.
struct Trial {
  Scenario scenario;
  std::vector<history::Finding> findings;
  std::string other;  ///< what is wrong beside the record: nothing goes on, a run does not repeat itself
  Outcome outcome;
  bool failed() const { return !findings.empty() || !other.empty(); }
  /// Returns in one sentence what is wrong first.
  std::string What() const;
};

/// Says what a campaign saw.
struct CampaignReport {
  uint64_t runs = 0, rounds = 0, datagrams = 0;
  double seconds = 0;            ///< virtual
  double judging = 0;            ///< seconds that the judge took for all of them
  Time recovery = 0;             ///< the longest of all runs, as in `Outcome`
  std::set<uint64_t> visited;    ///< as in `Outcome`
  std::optional<Trial> failure;  ///< the first, as short as it could be made
  bool stopped = false;
};

/// Makes runs until one fails. `judge` compiles a team of a size, as for the fleet.
CampaignReport Search(Fleet& fleet, const Fleet::MakeTeam& judge, const CampaignOptions& options);

/// Runs one scenario twice, compares, and judges.
Trial Try(Fleet& fleet, koord::semantics::Team& judge, const Scenario& scenario,
          CampaignReport* report = nullptr);

/// Returns a scenario with fewer and shorter faults that fails in the same way.
Trial Shrink(Fleet& fleet, koord::semantics::Team& judge, Trial failure, const base::StopToken& stop);

/// Returns what happened in a failing run, for people: the faults, what is wrong, and what the robots did
/// around it.
std::string Story(const Trial& failure);

}  // namespace rondo::sim::campaign
