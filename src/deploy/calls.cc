#include "deploy/calls.h"

#include <algorithm>

#include "koord/node/slow_calls.h"

namespace rondo::deploy {

using koord::semantics::Answer;

Calls::Calls(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
             uint64_t seed, PlannerThread* planner)
    : model_(model), functions_(model, fleet, seed) {
  for (const sim::FleetRobot& robot : fleet.robots) {
    bodies_.push_back(robot.make());
    bodies_.back()->Place(robot.position, robot.yaw);
    yaws_.push_back(robot.yaw);
  }
  const auto position = std::ranges::find(ports, sim::PortRole::kPosition, &sim::Port::role);
  if (position != ports.end()) position_ = &*position;
  if (planner != nullptr) {
    functions_.SetPlanner([this, planner](const sim::World& world, const sim::PlanRequest& request) {
      // `init` cannot go on without its answers.
      return planner->Ask(world, request, node_ == nullptr || node_->round() == 0);
    });
  }
}

void Calls::Attach(koord::semantics::Team& team, const koord::node::Node* node) {
  team_ = &team;
  node_ = node;
  functions_.Attach(team, bodies_);
  team.machine().SetHost(this);
}

Answer Calls::Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) {
  const Word* memory = team_->machine().memory();
  if (position_ != nullptr && memory != nullptr) {
    for (size_t r = 0; r < bodies_.size(); ++r)
      bodies_[r]->Place(sim::ReadPoint(memory + team_->layout().Address(position_->variable, r)), yaws_[r]);
  }
  const Answer answer = functions_.Call(f, robot, arguments, result);
  if (answer == Answer::kValue && model_.functions[f].port >= 0) {
    CallAnswer& kept = answers_.emplace_back();
    kept.question = koord::node::QuestionOf(*team_, f, robot, arguments);
    runtime::codec::Writer writer(kept.value);
    koord::node::EncodeValue(model_.types, team_->heap(), model_.functions[f].result, result, writer);
  }
  return answer;
}

}  // namespace rondo::deploy
