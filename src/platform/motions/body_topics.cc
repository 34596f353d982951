#include "platform/motions/body_topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

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
  expr::Numeric numeric(arena, {});
  constexpr double kTurn = 2 * std::numbers::pi, kRounding = 1e-9;
  const bool tells = yaw == nullptr || (yaw->least && yaw->most &&
                                        numeric(*yaw->most) - numeric(*yaw->least) <= kTurn + kRounding);
  if (x != nullptr && y != nullptr && tells) {
    topics.base = Base{scene.Of(x->term), scene.Of(y->term), std::nullopt, 0};
    if (yaw != nullptr) {
      topics.base->yaw = scene.Of(yaw->term);
      topics.base->heading = (numeric(*yaw->least) + numeric(*yaw->most)) / 2;
    }
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

std::vector<Signal> EnvironmentOf(const robot::World& world, const expr::Arena& arena,
                                  const sim::motions::SceneState& scene) {
  std::vector<Signal> signals;
  for (const robot::Variable& v : world.environment) {
    std::string name = "/environment";
    std::string_view rest = arena.symbol(arena.symbol_of(v.term)).name;
    while (!rest.empty()) {
      const size_t dot = std::min(rest.find('.'), rest.size());
      name += "/" + ros::Plain(rest.substr(0, dot));
      rest.remove_prefix(std::min(dot + 1, rest.size()));
    }
    signals.push_back({std::move(name), scene.Of(v.term)});
  }
  return signals;
}

std::string Collision(const robot::World& world, const expr::Arena& arena,
                      const sim::motions::SceneState& scene) {
  std::map<std::string, std::string> taken;  // by topic: of what
  std::string found;
  const auto take = [&](const std::string& topic, const std::string& of) {
    const auto [it, fresh] = taken.emplace(topic, of);
    if (!fresh && found.empty())
      found = fmt::format("{} and {} would both be `{}` in ROS: give one of them another name", it->second,
                          of, topic);
  };
  const auto named = [&](size_t place) {
    return fmt::format("`{}`", arena.symbol(arena.symbol_of(scene.variables()[place])).name);
  };
  for (size_t r = 0; r < world.bodies.size(); ++r) {
    const BodyTopics topics = TopicsOf(world, r, arena, scene);
    const std::string robot = fmt::format("`{}`", world.bodies[r].name.text);
    for (const char* topic : {"odom", "cmd_vel", "joint_states", "joint_trajectory", "events"})
      take(topics.Full(topic), robot);
    for (const Signal& s : topics.signals) take(s.topic, named(s.place));
  }
  for (const Signal& s : EnvironmentOf(world, arena, scene)) take(s.topic, named(s.place));
  return found;
}

}  // namespace rondo::platform
