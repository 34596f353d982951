#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "trace/writer.h"

/// ROS 2 messages as CDR (little endian), and their definitions. Lengths in metres, angles in radians, frame
/// `world` unless said otherwise (REP-103). Times: nanoseconds since the start of the run.
namespace rondo::trace {

struct Pose {
  std::array<double, 3> position{};
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w
};

extern const Schema kPoseStamped;
extern const Schema kLaserScan;
extern const Schema kMarkerArray;
extern const Schema kPath;
extern const Schema kOccupancyGrid;

std::string PoseStamped(uint64_t time, const Pose& pose);

struct Scan {
  std::string frame;
  float angle_min = 0;
  float angle_step = 0;
  float period = 0;  ///< seconds between scans
  float range_min = 0;
  float range_max = 0;
  std::vector<float> ranges;  ///< infinite: nothing in range
};
std::string LaserScan(uint64_t time, const Scan& scan);

/// An obstacle as a marker.
struct Marker {
  enum Kind : int32_t { kCube = 1, kSphere = 2, kCylinder = 3 };
  std::string group;
  int32_t id = 0;
  Kind kind = kCube;
  Pose pose;
  std::array<double, 3> size{};
  std::array<float, 4> colour{};
};
std::string MarkerArray(uint64_t time, const std::vector<Marker>& markers);
std::string Path(uint64_t time, const std::vector<std::array<double, 3>>& points);

/// Rows from low to high y, in each row cells from low to high x: -1 unknown, 0 free, 100 occupied.
struct Grid {
  float resolution = 1;  ///< metres
  uint32_t width = 0;
  uint32_t height = 0;
  std::array<double, 2> origin{};  ///< the lower corner of the first cell
  std::vector<int8_t> cells;
};
std::string OccupancyGrid(uint64_t time, const Grid& grid);
bool ReadGrid(std::string_view bytes, Grid& grid);

/// Reads back what `plot` needs. nullopt-like: false if the bytes are not such a message.
bool ReadPose(std::string_view bytes, Pose& pose);

}  // namespace rondo::trace
