#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "explore/search.h"
#include "koord/check/model.h"
#include "koord/semantics/team.h"

/// Explores all runs of a team, or random ones, and tells what they break.
namespace rondo::runs {

/// Says how far an exploration goes, what it checks, and which reductions it uses.
struct ExplorationOptions {
  std::optional<uint32_t> rounds;  ///< depth bound
  uint64_t states = 100'000'000;   ///< how many states are visited at most
  size_t memory = SIZE_MAX;        ///< how many bytes they take at most
  bool compact = false;    ///< keeps hashes of states only, so that a state may be missed (explore/search.h)
  bool deadlocks = false;  ///< reports states in which nothing can change any more
  bool reduce = true;      ///< see SystemOptions, and so for `symmetry`
  bool symmetry = true;
  std::optional<size_t> only;  ///< check this invariant alone
  unsigned jobs = 0;           ///< threads of a search; 0: one for each core
  uint64_t walks = 0;          ///< random walks instead of a search
  uint64_t steps = 1000;       ///< the length of a walk
  uint64_t seed = 1;
  std::map<size_t, std::vector<koord::semantics::Word>> params;
  std::map<size_t, std::vector<koord::semantics::Word>> choices;  ///< by variable, where none are declared
  std::function<void(const explore::SearchOptions::Progress&)> progress;
  base::StopToken stop;
};

/// Holds what the exploration of one team size found.
struct Explored {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  size_t robots = 0;
  explore::SearchResult search;
  uint64_t rounds = 0;        ///< how many rounds it takes to the deepest state
  uint64_t round_states = 0;  ///< with sensors, states are also counted in the middle of a round
  bool symmetric = false;
  bool broken = false;            ///< something was reported as an error
  bool stuck = false;             ///< somewhere no declared value of a sensor was allowed
  bool rounded = false;           ///< doubles were rounded in the run that breaks something
  bool unusable = false;          ///< the program cannot be executed: reported
  bool left = false;              ///< it was left unfinished, since another size breaks something
  uint64_t walked = 0;            ///< how many random walks were made
  nlohmann::json run;             ///< the counterexample, for `rondo replay`; null if there is none
  std::string property;           ///< what the run breaks, as `Replay` takes it
  std::vector<uint64_t> enabled;  ///< by event
  std::vector<bool> branches;     ///< taken, by number
  std::vector<diag::Span> branch_spans;
  std::vector<std::string> unchecked;  ///< invariants that runs are not checked against
  std::vector<std::string> zeroed;     ///< variables that start as zero because nothing says how
};

/// Explores one team. Everything that is wrong is reported as a diagnostic. Cost: exponential in the number
/// of robots, in time and memory, up to `states`.
Explored Explore(const koord::Model& model, size_t robots, const ExplorationOptions& options,
                 diag::Diagnostics& diagnostics);

/// Explores teams of several sizes, which take turns with more and more states, so that one that has no end hides no other. Ends with
/// the first that breaks something or cannot be run. Returns what was found of each size that had a turn, in the order of the sizes.
/// `progress` gets the size that is at work.
std::vector<Explored> ExploreSizes(
    const koord::Model& model, const std::vector<size_t>& sizes, const ExplorationOptions& options,
    const std::function<void(size_t, const explore::SearchOptions::Progress&)>& progress,
    diag::Diagnostics& diagnostics);

/// Returns the team sizes that the `explore` section names. Empty: none, or (after a report) no numbers.
std::vector<size_t> DeclaredSizes(const koord::Model& model, diag::Diagnostics& diagnostics);

}  // namespace rondo::runs
