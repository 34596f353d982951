#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/stop.h"
#include "history/record.h"
#include "koord/node/node.h"
#include "runtime/rounds/core.h"
#include "sim/campaign/scenario.h"

/// Runs a fleet of unchanged cores in virtual time, and records what they do.
namespace rondo::sim::campaign {

/// Tells how a run went, beside what it recorded.
struct Outcome {
  history::Record record;
  uint64_t rounds = 0;     ///< the latest that any robot committed
  uint64_t datagrams = 0;  ///< sent, each receiver counted
  uint64_t bytes = 0;
  Time time = 0;  ///< virtual, at the end
  /// From the end of the last fault until three more rounds were committed by all; 0 if they were not.
  Time recovery = 0;
  /// Says what should have gone on and did not, after all faults were over; empty if everything did.
  std::string stuck;
  /// Says what a core itself found broken.
  std::string broken;
  uint64_t digest = 0;  ///< of everything that happened: runs of one scenario have the same
  std::vector<uint64_t>
      visited;  ///< pairs of phases that some core went through, as in `cores::Cores::visited`
};

/// Holds what all runs of one program share: a compiled team for each robot.
class Fleet {
 public:
  /// Makes a team of this size; called once for each robot of the largest fleet of each size.
  using MakeTeam = std::function<std::unique_ptr<koord::semantics::Team>(size_t robots)>;
  explicit Fleet(MakeTeam make) : make_(std::move(make)) {}

  /// Runs a scenario to its end. The same scenario gives the same outcome.
  Outcome Run(const Scenario& scenario);

 private:
  struct Size {
    std::vector<std::unique_ptr<koord::semantics::Team>> teams;
    std::vector<std::unique_ptr<koord::node::Node>> nodes;
    history::Image start;  // before `init`
  };
  Size& Of(size_t robots);

  MakeTeam make_;
  std::vector<Size> sizes_;
};

}  // namespace rondo::sim::campaign
