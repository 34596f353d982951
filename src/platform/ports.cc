#include "platform/ports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "lang/suggest.h"

namespace rondo::platform {

using sim::BodyPort;
using sim::PortRole;
using sim::PortVia;

namespace {

// Looks at what a fleet file says of one port.
class PortCheck {
 public:
  PortCheck(const koord::Model& model, const sim::Fleet& fleet, diag::Diagnostics& diagnostics)
      : model_(model), fleet_(fleet), diagnostics_(diagnostics) {}

  void Run(const sim::Port& port) {
    const std::string name = NameOf(model_, port);
    const sim::FleetPort* said = Said(fleet_, name);
    if (said == nullptr) return;
    if (sim::IsActuator(model_, port) && said->max_age > 0) {
      diagnostics_.Report(diag::Kind::kFleetValue, said->span,
                          fmt::format("`{}` is an actuator: `max_age` is of sensors", name));
      return;
    }
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      const auto [what, help] = Wrong(port, name, *said, r);
      if (what.empty()) continue;
      auto& report = diagnostics_.Report(diag::Kind::kFleetValue, said->span, what);
      if (!help.empty()) report.Help(help);
      return;
    }
  }

 private:
  using Text = std::pair<std::string, std::string>;

  Text Wrong(const sim::Port& port, const std::string& name, const sim::FleetPort& said, size_t r) const {
    const bool goes = port.role == PortRole::kTarget || port.role == PortRole::kPath;
    const bool actuator = sim::IsActuator(model_, port);
    const sim::FleetRobot& robot = fleet_.robots[r];
    const bool number = port.own[r] && port.own[r]->kind == BodyPort::Kind::kNumber;
    switch (said.via) {
      case PortVia::kTopic:
        return {};
      case PortVia::kNav2:
        if (goes || port.role == PortRole::kReached) return {};
        return {fmt::format("Nav2 knows nothing of `{}`", name),
                "it is told where to go, and says whether it is there: `target` and `reached`"};
      case PortVia::kTwist:
      case PortVia::kAckermann: {
        const char* help = "name a topic for it: `{ ros2 = \"goal_pose\" }`";
        if (!goes)
          return {fmt::format("`{}` does not say where to go, so it cannot be made of velocities", name),
                  help};
        const bool steers = said.via == PortVia::kAckermann;
        const auto place = std::ranges::find_if(fleet_.ros.ports, [](const auto& p) {
          return p.second.via == PortVia::kAdapter &&
                 (p.first == "psn" || p.first == "position" || p.first == "pos");
        });
        if (place != fleet_.ros.ports.end())
          return {fmt::format("a controller has to know the heading, and `{}` does not say it", place->first),
                  "let odometry say where the robot is: `{ ros2 = \"odom\" }`"};
        if (BodyOf(r)->Told() && (!steers || robot.model == "car")) return {};
        return {fmt::format("`{}` is a `{}`, which is not driven by {}", robot.name, robot.model,
                            steers ? "an angle of steering" : "velocities in the plane"),
                help};
      }
      case PortVia::kPose:
      case PortVia::kTransform:
        if (port.role == PortRole::kPosition || port.role == PortRole::kHeading) return {};
        return {fmt::format("a pose does not say `{}`", name), "it says `psn` and `heading`"};
      case PortVia::kJointStates:
      case PortVia::kJointTrajectory: {
        const bool tells = said.via == PortVia::kJointTrajectory;
        if (number && tells == actuator) return {};
        return {
            fmt::format("`{}` is no {} of type `float`", name, tells ? "actuator" : "sensor"),
            "a joint is where a sensor of type `float` says (`joint_states`), and goes where an actuator says "
            "(`joint_trajectory`)"};
      }
      case PortVia::kPx4: {
        const bool flies = port.role == PortRole::kPosition || port.role == PortRole::kVelocity ||
                           port.role == PortRole::kHeading || port.role == PortRole::kTarget;
        if (!flies)
          return {fmt::format("an autopilot knows nothing of `{}`", name),
                  "it says `psn`, `velocity` and `heading`, and flies to a `target`"};
        if (!BodyOf(r)->flies())
          return {fmt::format("`{}` is a `{}`, which does not fly", robot.name, robot.model), {}};
        if (!robot.origin)
          return {fmt::format("nobody knows where the autopilot of `{}` counts from", robot.name),
                  "say it in its `[[robot]]`: `origin = \"start\"`, or a point: `origin = [x, y, z]`"};
        return {};
      }
      case PortVia::kAdapter:
        if (AdaptedAs(model_, port)) return {};
        return {fmt::format("`{}` is no `float`, `bool` or `pos`, which is what an adapter can have", name),
                {}};
    }
    return {};
  }

  std::unique_ptr<sim::Body> BodyOf(size_t r) const {
    auto body = fleet_.robots[r].make();
    body->Place(fleet_.robots[r].position, fleet_.robots[r].yaw);
    return body;
  }

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  diag::Diagnostics& diagnostics_;
};

// A topic of two robots would be read, or obeyed, by both; one that carries two things is heard by nobody; and where a robot is, one
// topic says.
void CheckShared(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
                 diag::Diagnostics& diagnostics) {
  struct Use {
    size_t robot;
    Topic topic;
  };
  std::map<std::string, Use> of;
  std::map<size_t, Topic> place;  // by robot
  const auto report = [&](size_t robot, std::string what) -> diag::Diagnostic& {
    return diagnostics.Report(diag::Kind::kFleetValue, fleet.robots[robot].span, std::move(what));
  };
  for (const sim::Port& port : ports) {
    for (size_t r = 0; r < fleet.robots.size(); ++r) {
      const auto topic = TopicOf(model, fleet, r, port);
      if (!topic || !topic->library.empty()) continue;
      if (topic->carries == Carries::kTransform) continue;  // all say on one topic where their frames are
      const auto& [robot, other] = of.emplace(topic->name, Use{r, *topic}).first->second;
      if (robot != r) {
        report(r, fmt::format("`{}` and `{}` have one topic for `{}`: {}", fleet.robots[robot].name,
                              fleet.robots[r].name, topic->port, topic->name))
            .Help("give each robot a `namespace` of its own, and topics that do not begin with `/`");
        return;
      }
      if (TypeOf(other.carries).name != TypeOf(topic->carries).name) {
        report(r, fmt::format("`{}` and `{}` are on one topic, {}, and need messages of two types",
                              other.port, topic->port, topic->name))
            .Help("name another topic for one of them in `[ports]`");
        return;
      }
      if (!SaysPlace(topic->carries)) continue;
      const Topic& first = place.emplace(r, *topic).first->second;
      if (first.name != topic->name) {
        report(r, fmt::format("`{}` and `{}` say by two topics where `{}` is, and how it moves: {} and {}",
                              first.port, topic->port, fleet.robots[r].name, first.name, topic->name))
            .Help("name one topic for both in `[ports]`");
        return;
      }
    }
  }
  std::map<std::string, size_t> spaces;
  for (size_t r = 0; r < fleet.robots.size(); ++r) {
    const auto [it, fresh] = spaces.emplace(fleet.robots[r].node_namespace, r);
    if (fresh) continue;
    report(r, fmt::format("`{}` and `{}` have one namespace: `{}`", fleet.robots[it->second].name,
                          fleet.robots[r].name, it->first));
    return;
  }
}

}  // namespace

std::vector<sim::Port> PortsOf(const koord::Model& model, const sim::Fleet& fleet,
                               diag::Diagnostics& diagnostics) {
  std::set<std::string> adapted;
  for (const auto& [name, port] : fleet.ros.ports) {
    if (port.via == PortVia::kAdapter) adapted.insert(name);
  }
  const size_t before = diagnostics.errors();
  std::vector<sim::Port> ports = sim::FindPorts(model, fleet.robots, diagnostics, adapted);
  if (diagnostics.errors() != before) return ports;
  std::set<std::string> known;
  PortCheck check(model, fleet, diagnostics);
  for (const sim::Port& port : ports) {
    known.insert(NameOf(model, port));
    check.Run(port);
  }
  CheckShared(model, fleet, ports, diagnostics);
  for (const auto& [name, port] : fleet.ros.ports) {
    if (known.contains(name)) continue;
    const std::string near = lang::Suggest(name, {known.begin(), known.end()});
    auto& report = diagnostics.Report(diag::Kind::kFleetValue, port.span,
                                      fmt::format("the program has no port `{}`", name));
    report.Help(near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                             : fmt::format("did you mean `{}`?", near));
  }
  return ports;
}

}  // namespace rondo::platform
