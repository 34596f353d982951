#pragma once

#include <memory>
#include <vector>

#include "deploy/planner.h"
#include "koord/node/node.h"
#include "sim/functions/functions.h"
#include "sim/ports.h"

namespace rondo::deploy {

using koord::semantics::Word;

/// Is what a function of a port answered: which question (`koord::node::QuestionOf`), and the value as frames have it.
struct CallAnswer {
  uint64_t question = 0;
  runtime::codec::Bytes value;
};

/// Computes the external functions of a program on a robot: those that need to know where robots are go by what their
/// sensors say. What functions of ports answer is kept, for the log: nobody can find it out again.
class Calls final : public koord::semantics::Host {
 public:
  /// @param planner  nullptr: answers are there at once.
  Calls(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
        uint64_t seed, PlannerThread* planner);
  sim::Functions& functions() { return functions_; }
  /// Connects it with the team that calls, and the node that it belongs to; both outlive the calls.
  void Attach(koord::semantics::Team& team, const koord::node::Node* node);

  koord::semantics::Answer Call(size_t f, size_t robot, std::span<const Word> arguments,
                                std::span<Word> result) override;
  void Log(size_t robot, size_t type, std::span<const Word> value) override {
    functions_.Log(robot, type, value);
  }

  /// Returns what was answered since this was cleared.
  const std::vector<CallAnswer>& answers() const { return answers_; }
  void Clear() { answers_.clear(); }

 private:
  const koord::Model& model_;
  sim::Functions functions_;
  std::vector<std::unique_ptr<sim::Body>> bodies_;  // by robot: where they seem to be
  std::vector<double> yaws_;
  const sim::Port* position_ = nullptr;
  koord::semantics::Team* team_ = nullptr;
  const koord::node::Node* node_ = nullptr;
  std::vector<CallAnswer> answers_;
};

}  // namespace rondo::deploy
