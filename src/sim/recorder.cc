#include "sim/recorder.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace rondo::sim {

using nlohmann::json;

Recorder::Recorder(trace::Writer* writer, const Fleet& fleet) : writer_(writer), fleet_(fleet) {}

uint64_t Recorder::Nanoseconds(double time) { return static_cast<uint64_t>(std::llround(time * 1e9)); }

uint16_t Recorder::Channel(const std::string& topic, const trace::Schema& schema, const char* encoding) {
  const auto it = channels_.find(topic);
  if (it != channels_.end()) return it->second;
  return channels_[topic] = writer_->Channel(topic, schema, encoding);
}

void Recorder::Run(const json& run) {
  if (on())
    writer_->Message(Channel("/rondo/run", trace::kRecord, "json"), 0,
                     run.dump(-1, ' ', false, json::error_handler_t::replace));
}

void Recorder::Round(double time, const json& round) {
  writer_->Message(Channel("/rondo/round", trace::kRecord, "json"), Nanoseconds(time), round.dump());
}

void Recorder::Event(double time, const json& event) {
  if (on())
    writer_->Message(Channel("/rondo/event", trace::kRecord, "json"), Nanoseconds(time), event.dump());
}

void Recorder::World(const Fleet& fleet) {
  if (!on()) return;
  std::vector<trace::Marker> markers;
  constexpr std::array<float, 4> kGrey{0.5F, 0.5F, 0.5F, 1.0F};
  for (const Box& b : fleet.world.boxes) {
    markers.push_back({"obstacles",
                       static_cast<int32_t>(markers.size()),
                       trace::Marker::kCube,
                       {b.centre, {0, 0, 0, 1}},
                       b.size,
                       kGrey});
  }
  for (const Cylinder& c : fleet.world.cylinders) {
    markers.push_back({"obstacles",
                       static_cast<int32_t>(markers.size()),
                       trace::Marker::kCylinder,
                       {c.centre, {0, 0, 0, 1}},
                       {2 * c.radius, 2 * c.radius, c.height},
                       kGrey});
  }
  writer_->Message(Channel("/world", trace::kMarkerArray, "cdr"), 0, trace::MarkerArray(0, markers));
}

void Recorder::Pose(double time, size_t robot, const Body& body) {
  if (!on()) return;
  const uint64_t at = Nanoseconds(time);
  const std::string& name = fleet_.robots[robot].name;
  const trace::Pose pose{body.position(), body.rotation()};
  writer_->Message(Channel("/" + name + "/pose", trace::kPoseStamped, "cdr"), at,
                   trace::PoseStamped(at, pose));
  // What scans lie in.
  writer_->Message(Channel("/tf", trace::kTransforms, "cdr"), at, trace::Transform(at, name, pose));
}

void Recorder::Path(double time, size_t robot, const std::vector<Point>& path) {
  if (!on()) return;
  const uint64_t at = Nanoseconds(time);
  writer_->Message(Channel("/" + fleet_.robots[robot].name + "/path", trace::kPath, "cdr"), at,
                   trace::Path(at, path));
}

void Recorder::Scan(double time, size_t robot, const Rays& rays, double yaw, double period) {
  if (!on()) return;
  trace::Scan scan;
  scan.frame = fleet_.robots[robot].name;
  scan.angle_min = static_cast<float>(rays.first - yaw);
  scan.angle_step = static_cast<float>(rays.step);
  scan.period = static_cast<float>(period);
  scan.range_max = static_cast<float>(rays.range);
  for (const double d : rays.distances) scan.ranges.push_back(static_cast<float>(d));
  const uint64_t at = Nanoseconds(time);
  writer_->Message(Channel("/" + fleet_.robots[robot].name + "/scan", trace::kLaserScan, "cdr"), at,
                   trace::LaserScan(at, scan));
}

void Recorder::Map(double time, const GridMap& map) {
  if (!on()) return;
  trace::Grid grid{static_cast<float>(map.cell),
                   static_cast<uint32_t>(map.columns),
                   static_cast<uint32_t>(map.rows),
                   {map.x0, map.y0},
                   {}};
  for (const int8_t c : map.cells) grid.cells.push_back(static_cast<int8_t>(c > 0 ? 100 : c));
  const uint64_t at = Nanoseconds(time);
  writer_->Message(Channel("/map", trace::kOccupancyGrid, "cdr"), at, trace::OccupancyGrid(at, grid));
}

}  // namespace rondo::sim
