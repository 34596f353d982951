#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "deploy/calls.h"
#include "koord/node/node.h"

namespace rondo::deploy {

/// Is a program with everything that a robot needs to run it, but the world: the team, its functions, the state before
/// `init`. Each thread has one of its own.
class Replica {
 public:
  /// Makes one. Reports what is wrong, and returns nullptr then.
  /// @param model, fleet, ports  outlive it; `planner`, too: nullptr if answers have to be there at once.
  static std::unique_ptr<Replica> Make(const koord::Model& model, const sim::Fleet& fleet,
                                       const std::vector<sim::Port>& ports, uint32_t robot, uint64_t seed,
                                       PlannerThread* planner, diag::Diagnostics& diagnostics);

  koord::semantics::Team& team() { return *team_; }
  koord::node::Node& node() { return *node_; }
  Calls& calls() { return calls_; }
  /// Returns the body of a robot as the fleet describes it, where it starts.
  const sim::Body& body(size_t robot) const { return *bodies_[robot]; }
  /// Returns the state before `init`, as frames have it: the same on all robots.
  const runtime::codec::Bytes& before() const { return before_; }

  /// Returns a state that a node saved; nothing if these bytes are none. Lists of states that it returned before may be gone.
  std::optional<std::vector<Word>> StateOf(runtime::codec::View bytes);

 private:
  Replica(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
          uint64_t seed, PlannerThread* planner)
      : calls_(model, fleet, ports, seed, planner) {}

  Calls calls_;
  std::vector<std::unique_ptr<sim::Body>> bodies_;
  std::unique_ptr<koord::semantics::Team> team_;
  std::unique_ptr<koord::node::Node> node_;
  runtime::codec::Bytes before_;
  size_t collect_at_ = 1'000'000;  // words of the heap
};

}  // namespace rondo::deploy
