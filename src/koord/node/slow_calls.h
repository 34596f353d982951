#pragma once

#include <cstdint>
#include <map>

#include "koord/node/node.h"

namespace rondo::koord::node {

/// Gives what another host gives, but for functions of ports after a while: planners compute while rounds go on. What is
/// asked again with the same arguments is the same question, and once there is an answer there is one at once. During `init` answers come at once:
/// nothing goes on without them.
class SlowCalls final : public semantics::Host {
 public:
  /// @param node  of the robot that asks; `now`: the time in nanoseconds. All have to outlive this.
  SlowCalls(semantics::Host& host, const semantics::Team& team, const Node& node, const int64_t& now)
      : host_(host), team_(team), node_(node), now_(now) {}

  /// Sets how long the answer to a new question takes, in nanoseconds; 0: none takes any time, and none that is waited for.
  void SetDelay(int64_t delay) { delay_ = delay; }
  /// Forgets all questions: a life begins.
  void Reset() { ready_.clear(); }

  semantics::Answer Call(size_t f, size_t robot, std::span<const Word> arguments,
                         std::span<Word> result) override;
  void Log(size_t robot, size_t type, std::span<const Word> value) override { host_.Log(robot, type, value); }

 private:
  semantics::Host& host_;
  const semantics::Team& team_;
  const Node& node_;
  const int64_t& now_;
  int64_t delay_ = 0;
  std::map<uint64_t, int64_t> ready_;  // by question: when there is an answer
};

/// Returns a number for a call: the same for the same function, robot and values, whatever the heap. Of a function of
/// no port, the robot does not matter.
uint64_t QuestionOf(const semantics::Team& team, size_t f, size_t robot, std::span<const Word> arguments);

}  // namespace rondo::koord::node
