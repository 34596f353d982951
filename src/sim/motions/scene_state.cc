#include "sim/motions/scene_state.h"

namespace rondo::sim::motions {

SceneState::SceneState(const robot::World& world) {
  const auto add = [&](const std::vector<robot::Variable>& list) {
    for (const robot::Variable& v : list) {
      if (places_.emplace(v.term, variables_.size()).second) variables_.push_back(v.term);
    }
  };
  for (const robot::Body& body : world.bodies) {
    add(body.states);
    add(body.memory);
    add(body.inputs);
    add(body.unknowns);
  }
  add(world.environment);
  clock_ = variables_.size();
  places_.emplace(world.clock, clock_);
  variables_.push_back(world.clock);
  values_.resize(variables_.size());
}

expr::Numeric::Point SceneState::Point() const {
  expr::Numeric::Point point;
  for (size_t i = 0; i < variables_.size(); ++i) point.emplace(variables_[i], values_[i]);
  return point;
}

}  // namespace rondo::sim::motions
