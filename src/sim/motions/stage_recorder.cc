#include "sim/motions/stage_recorder.h"

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "trace/ros.h"

namespace rondo::sim::motions {

using nlohmann::json;
using robot::ShapeKind;

namespace {

constexpr double kShow = 0.05;  // seconds

uint64_t Nanoseconds(double time) { return static_cast<uint64_t>(std::llround(time * 1e9)); }

Eigen::Isometry3d PoseIn(std::span<const double> n) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (size_t j = 0; j < 3; ++j) pose.linear()(row, static_cast<Eigen::Index>(j)) = n[3 * i + j];
    pose.translation()(row) = n[9 + i];
  }
  return pose;
}

trace::Pose PoseOf(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& t = pose.translation();
  return {{t[0], t[1], t[2]}, {q.x(), q.y(), q.z(), q.w()}};
}

// The surface of a prism as triangles, counterclockwise from outside.
std::vector<std::array<double, 3>> Triangles(const std::vector<double>& n) {
  std::vector<std::array<double, 3>> corners;
  const size_t count = (n.size() - 2) / 2;
  const auto at = [&](size_t i, bool top) {
    const size_t k = 2 + 2 * (i % count);
    return std::array<double, 3>{n[k], n[k + 1], top ? n[1] : n[0]};
  };
  for (size_t i = 0; i < count; ++i) {
    corners.insert(corners.end(), {at(i, false), at(i + 1, false), at(i + 1, true)});
    corners.insert(corners.end(), {at(i, false), at(i + 1, true), at(i, true)});
    if (i == 0 || i + 1 == count) continue;
    corners.insert(corners.end(), {at(0, true), at(i, true), at(i + 1, true)});
    corners.insert(corners.end(), {at(0, false), at(i + 1, false), at(i, false)});
  }
  return corners;
}

// What a solid looks like where it stands.
std::vector<trace::Marker> Markers(const std::string& group, const robot::Solid& solid,
                                   const std::array<float, 4>& colour) {
  std::vector<trace::Marker> markers;
  for (const robot::SolidPart& part : solid.Standing()) {
    Eigen::Isometry3d pose = PoseIn(part.frame);
    const std::vector<double>& n = part.sizes;
    const auto add = [&](trace::Marker::Kind kind, const Eigen::Vector3d& middle,
                         const std::array<double, 3>& size) {
      Eigen::Isometry3d at = pose;
      at.translation() += pose.linear() * middle;
      markers.push_back({group, static_cast<int32_t>(markers.size()), kind, PoseOf(at), size, colour});
    };
    const auto ball = [&](double radius, double z) {
      add(trace::Marker::kSphere, {0, 0, z}, {2 * radius, 2 * radius, 2 * radius});
    };
    switch (part.kind) {
      case ShapeKind::kSphere:
        ball(n[0], 0);
        break;
      case ShapeKind::kCapsule:
        ball(n[0], n[1]);
        ball(n[0], n[2]);
        [[fallthrough]];
      case ShapeKind::kCylinder:
        add(trace::Marker::kCylinder, {0, 0, (n[1] + n[2]) / 2}, {2 * n[0], 2 * n[0], n[2] - n[1]});
        break;
      case ShapeKind::kBox:
        add(trace::Marker::kCube, {(n[0] + n[1]) / 2, (n[2] + n[3]) / 2, (n[4] + n[5]) / 2},
            {n[1] - n[0], n[3] - n[2], n[5] - n[4]});
        break;
      case ShapeKind::kPrism:
        add(trace::Marker::kTriangles, {0, 0, 0}, {1, 1, 1});
        markers.back().corners = Triangles(n);
        break;
      case ShapeKind::kHalfSpace:
      case ShapeKind::kHalfSphere:
      case ShapeKind::kUnion:
      case ShapeKind::kIntersection:
        break;
    }
  }
  return markers;
}

}  // namespace

StageRecorder::StageRecorder(trace::Writer& writer, const choreo::Graph& graph, expr::Arena& arena,
                             const json& run)
    : writer_(writer), graph_(graph), scene_(*graph.world) {
  writer_.Message(Channel("/rondo/run", trace::kRecord, "json"), 0,
                  run.dump(-1, ' ', false, json::error_handler_t::replace));
  for (const robot::Body& body : graph.world->bodies) {
    Robot& robot = robots_.emplace_back();
    std::vector<expr::TermId> numbers;
    const auto add = [&](const std::string& name, const robot::Pose& pose) {
      robot.frames.push_back({name});
      for (const robot::Vector& row : pose.rotation) numbers.insert(numbers.end(), row.begin(), row.end());
      numbers.insert(numbers.end(), pose.origin.begin(), pose.origin.end());
    };
    add(body.name.text, body.self);
    size_t base = 0;
    for (const auto& [name, value] : body.scope.names) {
      if (value.kind != robot::ValueKind::kFrame || name == "self") continue;
      if (name == "base") base = robot.frames.size();
      add(body.name.text + "/" + name, *value.pose);
    }
    robot.frames[base].pose = true;
    auto poses = Functions::Of(arena, numbers, scene_.variables());
    if (poses.ok()) robot.poses = std::move(poses).value();
    if (body.body) robot.body = robot::Solid::Of(arena, *body.body, scene_.variables());
    for (const robot::Variable& v : body.states) {
      robot.states.push_back(v.name.text);
      robot.places.push_back(scene_.Of(v.term));
    }
  }
  std::vector<trace::Marker> markers;
  for (const robot::Obstacle& o : graph.world->obstacles) {
    auto solid = robot::Solid::Of(arena, o.shape, scene_.variables());
    if (!solid) continue;
    solid->Place(scene_.values());
    for (trace::Marker& m : Markers(o.name.text, *solid, {0.5F, 0.5F, 0.5F, 1.0F}))
      markers.push_back(std::move(m));
  }
  writer_.Message(Channel("/world", trace::kMarkerArray, "cdr"), 0, trace::MarkerArray(0, markers));
}

uint16_t StageRecorder::Channel(const std::string& topic, const trace::Schema& schema, const char* encoding) {
  const auto it = channels_.find(topic);
  if (it != channels_.end()) return it->second;
  return channels_[topic] = writer_.Channel(topic, schema, encoding);
}

void StageRecorder::Event(double time, const json& event) {
  writer_.Message(Channel("/rondo/event", trace::kRecord, "json"), Nanoseconds(time), event.dump());
}

void StageRecorder::Message(double time, uint32_t from, uint32_t to, const std::string& label,
                            const std::vector<double>& values) {
  Event(time, {{"kind", "message"},
               {"from", graph_.NameOf(choreo::RobotId(from))},
               {"to", graph_.NameOf(choreo::RobotId(to))},
               {"label", label},
               {"values", values}});
}

void StageRecorder::Begins(double time, size_t robot, const std::string& motion) {
  Event(time, {{"kind", "begins"}, {"robot", graph_.NameOf(choreo::RobotId(robot))}, {"motion", motion}});
}

void StageRecorder::Ends(double time, size_t robot, const std::string& motion) {
  Event(time, {{"kind", "ends"}, {"robot", graph_.NameOf(choreo::RobotId(robot))}, {"motion", motion}});
}

void StageRecorder::Incident(double time, Wrong wrong, const std::string& what) {
  Event(time, {{"kind", "incident"}, {"wrong", Name(wrong)}, {"what", what}});
}

void StageRecorder::Scene(double time, const SceneState& scene) {
  constexpr double kMoment = 1e-9;
  if (time < shown_ + kShow - kMoment && shown_ >= 0) return;
  Show(time, scene);
}

void StageRecorder::Show(double time, const SceneState& scene) {
  shown_ = time;
  const uint64_t at = Nanoseconds(time);
  std::vector<trace::Marker> markers;
  for (size_t r = 0; r < robots_.size(); ++r) {
    Robot& robot = robots_[r];
    const std::string& name = graph_.world->bodies[r].name.text;
    const auto numbers = robot.poses ? (*robot.poses)(scene.values()) : std::span<const double>{};
    for (size_t f = 0; f < numbers.size() / 12; ++f) {
      const trace::Pose pose = PoseOf(PoseIn(numbers.subspan(12 * f, 12)));
      if (robot.frames[f].pose)
        writer_.Message(Channel("/" + name + "/pose", trace::kPoseStamped, "cdr"), at,
                        trace::PoseStamped(at, pose));
      writer_.Message(Channel("/tf", trace::kTransforms, "cdr"), at,
                      trace::Transform(at, robot.frames[f].name, pose));
    }
    std::vector<double> positions;
    for (const size_t place : robot.places) positions.push_back(scene.values()[place]);
    if (!positions.empty())
      writer_.Message(Channel("/" + name + "/joint_states", trace::kJointState, "cdr"), at,
                      trace::JointState(at, robot.states, positions));
    if (!robot.body) continue;
    robot.body->Place(scene.values());
    constexpr std::array<std::array<float, 4>, 4> kColours{
        {{0.25F, 0.5F, 1, 1}, {1, 0.55F, 0.1F, 1}, {0.2F, 0.7F, 0.3F, 1}, {0.7F, 0.3F, 0.8F, 1}}};
    for (trace::Marker& m : Markers(name, *robot.body, kColours[r % kColours.size()]))
      markers.push_back(std::move(m));
  }
  writer_.Message(Channel("/bodies", trace::kMarkerArray, "cdr"), at, trace::MarkerArray(at, markers));
}

void StageRecorder::Finish(double time, const SceneState& scene, const ChoreographyReport& report) {
  if (time > shown_) Show(time, scene);
  json end{{"kind", "end"}, {"why", Name(report.ended)}};
  if (!report.lost.empty()) end["lost"] = report.lost;
  Event(time, end);
}

}  // namespace rondo::sim::motions
