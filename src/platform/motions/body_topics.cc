#include "platform/motions/body_topics.h"

#include <algorithm>

#include "robot/values/value.h"
#include "ros/names.h"

namespace rondo::platform {

namespace {

const robot::Variable* Find(const robot::Body& body, lang::Dimension dimension,
                            std::initializer_list<std::string_view> names) {
  for (const robot::Variable& v : body.states) {
    if (v.dimension == dimension && std::ranges::find(names, v.name.text) != names.end()) return &v;
  }
  return nullptr;
}

}  // namespace

BodyTopics TopicsOf(const robot::World& world, size_t robot, const expr::Arena& arena,
                    const sim::motions::SceneState& scene) {
  const robot::Body& body = world.bodies[robot];
  BodyTopics topics;
  topics.node_namespace = ros::Plain(body.name.text);
  const auto *x = Find(body, robot::kLength, {"x"}), *y = Find(body, robot::kLength, {"y"});
  const auto* yaw = Find(body, robot::kAngle, {"theta", "yaw"});
  if (x != nullptr && y != nullptr) {
    topics.base = Base{scene.Of(x->term), scene.Of(y->term), std::nullopt};
    if (yaw != nullptr) topics.base->yaw = scene.Of(yaw->term);
  }
  for (const robot::Variable& v : body.states) {
    if (!topics.base || (&v != x && &v != y && &v != yaw))
      topics.joints.push_back({v.name.text, scene.Of(v.term)});
  }
  std::vector<expr::TermId> rates;
  for (const auto& d : body.derivatives) {
    if (d) rates.push_back(*d);
  }
  const auto moving = robot::VariablesOf(arena, rates);
  const auto hear = [&](const robot::Variable& v) {
    topics.signals.push_back({topics.Full(ros::Plain(v.name.text)), scene.Of(v.term)});
  };
  for (const robot::Variable& v : body.inputs) {
    if (std::ranges::find(moving, v.term) == moving.end()) hear(v);
  }
  for (const robot::Variable& v : body.unknowns) hear(v);
  return topics;
}

std::vector<Signal> EnvironmentOf(const robot::World& world, const sim::motions::SceneState& scene) {
  std::vector<Signal> signals;
  for (const robot::Variable& v : world.environment)
    signals.push_back({"/environment/" + ros::Plain(v.name.text), scene.Of(v.term)});
  return signals;
}

}  // namespace rondo::platform
