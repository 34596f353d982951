#pragma once

#include <map>

#include "koord/node/node.h"
#include "sim/campaign/any_functions.h"
#include "transport/simulated/network.h"

namespace rondo::sim::campaign {

/// Gives what `AnyFunctions` gives, after a while: as a planner that computes while rounds go on. What is asked again
/// with the same arguments is the same question, and its answer is kept. During `init` answers come at once: nothing
/// goes on without them.
class SlowFunctions final : public koord::semantics::Host {
 public:
  using Time = transport::simulated::Time;
  /// @param node  of the robot that asks; `now`: the time. Both have to outlive this.
  SlowFunctions(koord::semantics::Team& team, const koord::node::Node& node, const Time& now)
      : any_(team), node_(node), now_(now) {}

  /// Sets how long an answer to a new question takes.
  void SetDelay(Time delay) { delay_ = delay; }
  /// Forgets all questions: a life begins.
  void Reset() { ready_.clear(); }

  koord::semantics::Answer Call(size_t f, size_t robot, std::span<const koord::semantics::Word> arguments,
                                std::span<koord::semantics::Word> result) override;
  void Log(size_t, size_t, std::span<const koord::semantics::Word>) override {}

 private:
  AnyFunctions any_;
  const koord::node::Node& node_;
  const Time& now_;
  Time delay_ = 0;
  std::map<uint64_t, Time> ready_;  // by question: when there is an answer
};

}  // namespace rondo::sim::campaign
