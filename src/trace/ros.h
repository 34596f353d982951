#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/message.h"
#include "trace/writer.h"

/// What runs show, as ROS 2 messages in CDR. Lengths in metres, angles in radians, frame
/// `world` unless said otherwise (REP-103). Times: nanoseconds since the start of the run.
namespace rondo::trace {

/// Is a place and an orientation in frame `world`: of the body's frame, seen from the world.
struct Pose {
  std::array<double, 3> position{};            ///< x, y, z in metres
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< unit quaternion x, y, z, w
};

/// Returns how messages of a type are written in traces.
Schema SchemaOf(const ros::Message& message);

/// Define the messages that the functions below write.
extern const Schema kPoseStamped;
extern const Schema kLaserScan;
extern const Schema kMarkerArray;
extern const Schema kPath;
extern const Schema kOccupancyGrid;
extern const Schema kTransforms;
extern const Schema kJointState;

/// Returns a geometry_msgs/msg/PoseStamped.
std::string PoseStamped(uint64_t time, const Pose& pose);
/// Returns a tf2_msgs/msg/TFMessage that says where a frame is.
std::string Transform(uint64_t time, const std::string& frame, const Pose& pose);

/// Returns a sensor_msgs/msg/JointState: a name for each position, in metres or radians.
std::string JointState(uint64_t time, const std::vector<std::string>& names,
                       const std::vector<double>& positions);
/// Reads one; false if the bytes are none, or have not a name for each position.
bool ReadJointState(std::string_view bytes, std::vector<std::string>& names, std::vector<double>& positions);

/// Is what a laser scanner saw in one turn. Angles in radians, in the plane of its own frame; ranges in
/// metres.
struct Scan {
  std::string frame;     ///< the name of the scanner's frame
  float angle_min = 0;   ///< of the first range
  float angle_step = 0;  ///< from one range to the next
  float period = 0;      ///< seconds between scans
  float range_min = 0;
  float range_max = 0;
  std::vector<float> ranges;  ///< metres, by angle; infinite: nothing in range
};
/// Returns a sensor_msgs/msg/LaserScan.
std::string LaserScan(uint64_t time, const Scan& scan);

/// Is something to be shown as a solid.
struct Marker {
  enum Kind : int32_t { kCube = 1, kSphere = 2, kCylinder = 3, kTriangles = 11 };
  std::string group;  ///< the marker's namespace; with `id` it names the marker
  int32_t id = 0;
  Kind kind = kCube;
  Pose pose;                      ///< of its middle
  std::array<double, 3> size{};   ///< extents along its own x, y, z in metres
  std::array<float, 4> colour{};  ///< red, green, blue, opacity, from 0 to 1
  std::vector<std::array<double, 3>>
      corners{};  ///< kTriangles: three for each, counterclockwise from outside; metres
};
/// Returns a visualization_msgs/msg/MarkerArray.
std::string MarkerArray(uint64_t time, const std::vector<Marker>& markers);
/// Returns a nav_msgs/msg/Path through these points, in metres; orientations are the identity.
std::string Path(uint64_t time, const std::vector<std::array<double, 3>>& points);

/// Is a map of occupied cells. `cells`: rows from low to high y, in each row cells from low to high x: -1
/// unknown, 0 free, 100 occupied.
struct Grid {
  float resolution = 1;            ///< the side of a cell in metres
  uint32_t width = 0;              ///< cells in a row
  uint32_t height = 0;             ///< rows
  std::array<double, 2> origin{};  ///< the lower corner of the first cell, x and y in metres
  std::vector<int8_t> cells;
};
/// Returns a nav_msgs/msg/OccupancyGrid.
std::string OccupancyGrid(uint64_t time, const Grid& grid);
/// Reads an OccupancyGrid back. Returns false, and leaves `grid` as it was, if the bytes are no such message.
bool ReadGrid(std::string_view bytes, Grid& grid);

/// Reads the pose of a PoseStamped back. Returns false if the bytes are no such message.
bool ReadPose(std::string_view bytes, Pose& pose);

}  // namespace rondo::trace
