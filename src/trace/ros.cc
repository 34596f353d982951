#include "trace/ros.h"

#include "ros/geometry_msgs.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/tf2_msgs.h"
#include "ros/visualization_msgs.h"

namespace rondo::trace {

using ros::Serialised;

const Schema kPoseStamped = SchemaOf(ros::geometry_msgs::PoseStamped::kMessage);
const Schema kPath = SchemaOf(ros::nav_msgs::Path::kMessage);
const Schema kLaserScan = SchemaOf(ros::sensor_msgs::LaserScan::kMessage);
const Schema kMarkerArray = SchemaOf(ros::visualization_msgs::MarkerArray::kMessage);
const Schema kOccupancyGrid = SchemaOf(ros::nav_msgs::OccupancyGrid::kMessage);
const Schema kJointState = SchemaOf(ros::sensor_msgs::JointState::kMessage);
const Schema kTransforms = SchemaOf(ros::tf2_msgs::TFMessage::kMessage);

Schema SchemaOf(const ros::Message& message) {
  return {message.name, "ros2msg", message.definition, message.hash};
}

namespace {

ros::std_msgs::Header HeaderOf(uint64_t time, std::string_view frame) {
  ros::std_msgs::Header header;
  header.stamp.sec = static_cast<int32_t>(time / 1'000'000'000);
  header.stamp.nanosec = static_cast<uint32_t>(time % 1'000'000'000);
  header.frame_id = frame;
  return header;
}

ros::geometry_msgs::Pose PoseOf(const Pose& pose) {
  ros::geometry_msgs::Pose p;
  p.position.x = pose.position[0];
  p.position.y = pose.position[1];
  p.position.z = pose.position[2];
  p.orientation.x = pose.rotation[0];
  p.orientation.y = pose.rotation[1];
  p.orientation.z = pose.rotation[2];
  p.orientation.w = pose.rotation[3];
  return p;
}

}  // namespace

std::string PoseStamped(uint64_t time, const Pose& pose) {
  ros::geometry_msgs::PoseStamped m;
  m.header = HeaderOf(time, "world");
  m.pose = PoseOf(pose);
  return Serialised(m);
}

std::string Transform(uint64_t time, const std::string& frame, const Pose& pose) {
  ros::tf2_msgs::TFMessage m;
  auto& t = m.transforms.emplace_back();
  t.header = HeaderOf(time, "world");
  t.child_frame_id = frame;
  t.transform.translation = {pose.position[0], pose.position[1], pose.position[2]};
  t.transform.rotation = PoseOf(pose).orientation;
  return Serialised(m);
}

std::string JointState(uint64_t time, const std::vector<std::string>& names,
                       const std::vector<double>& positions) {
  ros::sensor_msgs::JointState m;
  m.header = HeaderOf(time, "");
  m.name = names;
  m.position = positions;
  return Serialised(m);
}

bool ReadJointState(std::string_view bytes, std::vector<std::string>& names, std::vector<double>& positions) {
  ros::sensor_msgs::JointState m;
  if (!ros::Parse(bytes, m) || m.name.size() != m.position.size()) return false;
  names = std::move(m.name);
  positions = std::move(m.position);
  return true;
}

std::string OccupancyGrid(uint64_t time, const Grid& grid) {
  ros::nav_msgs::OccupancyGrid m;
  m.header = HeaderOf(time, "world");
  m.info.resolution = grid.resolution;
  m.info.width = grid.width;
  m.info.height = grid.height;
  m.info.origin = PoseOf({{grid.origin[0], grid.origin[1], 0}, {0, 0, 0, 1}});
  m.data = grid.cells;
  return Serialised(m);
}

bool ReadGrid(std::string_view bytes, Grid& grid) {
  ros::nav_msgs::OccupancyGrid m;
  if (!ros::Parse(bytes, m) || m.data.size() != uint64_t{m.info.width} * m.info.height) return false;
  const auto& at = m.info.origin.position;
  grid = {m.info.resolution, m.info.width, m.info.height, {at.x, at.y}, std::move(m.data)};
  return true;
}

std::string Path(uint64_t time, const std::vector<std::array<double, 3>>& points) {
  ros::nav_msgs::Path m;
  m.header = HeaderOf(time, "world");
  for (const auto& p : points) {
    auto& stamped = m.poses.emplace_back();
    stamped.header = m.header;
    stamped.pose = PoseOf({p, {0, 0, 0, 1}});
  }
  return Serialised(m);
}

std::string LaserScan(uint64_t time, const Scan& scan) {
  ros::sensor_msgs::LaserScan m;
  m.header = HeaderOf(time, scan.frame);
  m.angle_min = scan.angle_min;
  m.angle_max =
      scan.angle_min + scan.angle_step * static_cast<float>(scan.ranges.empty() ? 0 : scan.ranges.size() - 1);
  m.angle_increment = scan.angle_step;
  m.scan_time = scan.period;
  m.range_min = scan.range_min;
  m.range_max = scan.range_max;
  m.ranges = scan.ranges;
  return Serialised(m);
}

std::string MarkerArray(uint64_t time, const std::vector<Marker>& markers) {
  ros::visualization_msgs::MarkerArray array;
  for (const Marker& from : markers) {
    auto& m = array.markers.emplace_back();
    m.header = HeaderOf(time, "world");
    m.ns = from.group;
    m.id = from.id;
    m.type = from.kind;
    m.pose = PoseOf(from.pose);
    m.scale.x = from.size[0];
    m.scale.y = from.size[1];
    m.scale.z = from.size[2];
    m.color.r = from.colour[0];
    m.color.g = from.colour[1];
    m.color.b = from.colour[2];
    m.color.a = from.colour[3];
    for (const auto& [x, y, z] : from.corners) m.points.push_back({x, y, z});
  }
  return Serialised(array);
}

bool ReadPose(std::string_view bytes, Pose& pose) {
  ros::geometry_msgs::PoseStamped m;
  if (!ros::Parse(bytes, m)) return false;
  const auto& [p, q] = m.pose;
  pose = {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
  return true;
}

}  // namespace rondo::trace
