#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sim/fleet/fleet.h"
#include "sim/functions/grid_map.h"
#include "trace/ros.h"

/// Records simulations as traces.
namespace rondo::sim {

/// Writes what happens in a simulation to a trace; does nothing without one.
///
/// Topics: `/rondo/run` (once, JSON: everything that a replay needs), `/rondo/round` and `/rondo/event`
/// (JSON), `/ROBOT/pose` (PoseStamped), `/tf`
/// (TFMessage: where the frame ROBOT is), `/ROBOT/path` (Path), `/ROBOT/scan` (LaserScan), `/world`
/// (MarkerArray), `/map` (OccupancyGrid).
class Recorder {
 public:
  Recorder(trace::Writer* writer, const Fleet& fleet);

  /// Reports whether there is a trace, so that others can save the work for one.
  bool on() const { return writer_ != nullptr; }
  /// Writes a message of each topic; times are seconds since the beginning of the run.
  void Run(const nlohmann::json& run);
  void World(const Fleet& fleet);
  void Round(double time, const nlohmann::json& round);
  void Event(double time, const nlohmann::json& event);
  void Pose(double time, size_t robot, const Body& body);
  void Path(double time, size_t robot, const std::vector<Point>& path);
  void Scan(double time, size_t robot, const Rays& rays, double yaw, double period);
  void Map(double time, const GridMap& map);

  /// Converts seconds to the unit of traces.
  static uint64_t Nanoseconds(double time);

 private:
  uint16_t Channel(const std::string& topic, const trace::Schema& schema, const char* encoding);

  trace::Writer* writer_;
  const Fleet& fleet_;
  std::map<std::string, uint16_t> channels_;
};

}  // namespace rondo::sim
