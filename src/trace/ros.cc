#include "trace/ros.h"

#include "trace/bytes.h"

namespace rondo::trace {

// The definitions of the interfaces, with those that they use behind a line of signs, as `ros2msg` wants
// them.
#define RONDO_SEPARATOR "================================================================================\n"
#define RONDO_TIME RONDO_SEPARATOR "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
#define RONDO_DURATION RONDO_SEPARATOR "MSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n"
#define RONDO_HEADER RONDO_SEPARATOR "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
#define RONDO_POINT RONDO_SEPARATOR "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
#define RONDO_VECTOR RONDO_SEPARATOR "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
#define RONDO_QUATERNION \
  RONDO_SEPARATOR "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
#define RONDO_POSE                                                                   \
  RONDO_SEPARATOR                                                                    \
  "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion " \
  "orientation\n" RONDO_POINT RONDO_QUATERNION

const Schema kPoseStamped{
    "geometry_msgs/msg/PoseStamped", "ros2msg",
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n" RONDO_HEADER RONDO_TIME RONDO_POSE};
const Schema kPath{
    "nav_msgs/msg/Path", "ros2msg",
    "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" RONDO_HEADER RONDO_TIME RONDO_SEPARATOR
    "MSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n" RONDO_POSE};
const Schema kLaserScan{"sensor_msgs/msg/LaserScan", "ros2msg",
                        "std_msgs/Header header\n"
                        "float32 angle_min\n"
                        "float32 angle_max\n"
                        "float32 angle_increment\n"
                        "float32 time_increment\n"
                        "float32 scan_time\n"
                        "float32 range_min\n"
                        "float32 range_max\n"
                        "float32[] ranges\n"
                        "float32[] intensities\n" RONDO_HEADER RONDO_TIME};
const Schema kMarkerArray{
    "visualization_msgs/msg/MarkerArray", "ros2msg",
    "visualization_msgs/Marker[] markers\n" RONDO_SEPARATOR
    "MSG: visualization_msgs/Marker\n"
    "std_msgs/Header header\n"
    "string ns\n"
    "int32 id\n"
    "int32 type\n"
    "int32 action\n"
    "geometry_msgs/Pose pose\n"
    "geometry_msgs/Vector3 scale\n"
    "std_msgs/ColorRGBA color\n"
    "builtin_interfaces/Duration lifetime\n"
    "bool frame_locked\n"
    "geometry_msgs/Point[] points\n"
    "std_msgs/ColorRGBA[] colors\n"
    "string texture_resource\n"
    "sensor_msgs/CompressedImage texture\n"
    "visualization_msgs/UVCoordinate[] uv_coordinates\n"
    "string text\n"
    "string mesh_resource\n"
    "visualization_msgs/MeshFile mesh_file\n"
    "bool mesh_use_embedded_materials\n" RONDO_HEADER RONDO_TIME RONDO_DURATION RONDO_POSE RONDO_VECTOR
        RONDO_SEPARATOR
    "MSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n" RONDO_SEPARATOR
    "MSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n" RONDO_SEPARATOR
    "MSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n" RONDO_SEPARATOR
    "MSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data\n"};

const Schema kOccupancyGrid{
    "nav_msgs/msg/OccupancyGrid", "ros2msg",
    "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n" RONDO_HEADER RONDO_TIME RONDO_SEPARATOR
    "MSG: nav_msgs/MapMetaData\n"
    "builtin_interfaces/Time map_load_time\n"
    "float32 resolution\n"
    "uint32 width\n"
    "uint32 height\n"
    "geometry_msgs/Pose origin\n" RONDO_POSE};

namespace {

// Common Data Representation, version 1: values stand at multiples of their size, counted behind the header.
class Cdr {
 public:
  Cdr() { out_.assign("\x00\x01\x00\x00", 4); }
  template <typename T>
  void Value(T value) {
    while ((out_.size() - 4) % sizeof(T) != 0) out_ += '\0';
    Put(out_, value);
  }
  void Text(std::string_view text) {
    Value<uint32_t>(static_cast<uint32_t>(text.size() + 1));
    out_.append(text);
    out_ += '\0';
  }
  void Header(uint64_t time, std::string_view frame) {
    Value<int32_t>(static_cast<int32_t>(time / 1'000'000'000));
    Value<uint32_t>(static_cast<uint32_t>(time % 1'000'000'000));
    Text(frame);
  }
  void ThePose(const Pose& pose) {
    for (const double x : pose.position) Value(x);
    for (const double x : pose.rotation) Value(x);
  }
  std::string Take() { return std::move(out_); }

 private:
  std::string out_;
};

}  // namespace

std::string PoseStamped(uint64_t time, const Pose& pose) {
  Cdr cdr;
  cdr.Header(time, "world");
  cdr.ThePose(pose);
  return cdr.Take();
}

std::string OccupancyGrid(uint64_t time, const Grid& grid) {
  Cdr cdr;
  cdr.Header(time, "world");
  cdr.Value<int32_t>(0);
  cdr.Value<uint32_t>(0);
  cdr.Value(grid.resolution);
  cdr.Value(grid.width);
  cdr.Value(grid.height);
  cdr.ThePose({{grid.origin[0], grid.origin[1], 0}, {0, 0, 0, 1}});
  cdr.Value<uint32_t>(static_cast<uint32_t>(grid.cells.size()));
  for (const int8_t c : grid.cells) cdr.Value(c);
  return cdr.Take();
}

bool ReadGrid(std::string_view bytes, Grid& grid) {
  Cursor c(bytes);
  if (!c.Take(uint64_t{12})) return false;
  const auto frame = c.TakeText();
  if (!frame) return false;
  // Four bytes each from here on, then doubles.
  if (!c.Take(static_cast<uint64_t>((4 - frame->size() % 4) % 4)) || !c.Take(uint64_t{8})) return false;
  const auto resolution = c.Take<float>();
  const auto width = c.Take<uint32_t>();
  const auto height = c.Take<uint32_t>();
  const size_t used = bytes.size() - c.rest().size() - 4;
  if (!resolution || !width || !height || !c.Take(static_cast<uint64_t>((8 - used % 8) % 8))) return false;
  const auto x = c.Take<double>();
  const auto y = c.Take<double>();
  if (!x || !y || !c.Take(uint64_t{40})) return false;
  const auto count = c.Take<uint32_t>();
  if (!count || *count != uint64_t{*width} * *height || *count != c.rest().size()) return false;
  grid = {*resolution, *width, *height, {*x, *y}, {}};
  for (const char cell : c.rest()) grid.cells.push_back(static_cast<int8_t>(cell));
  return true;
}

std::string Path(uint64_t time, const std::vector<std::array<double, 3>>& points) {
  Cdr cdr;
  cdr.Header(time, "world");
  cdr.Value<uint32_t>(static_cast<uint32_t>(points.size()));
  for (const auto& p : points) {
    cdr.Header(time, "world");
    cdr.ThePose({p, {0, 0, 0, 1}});
  }
  return cdr.Take();
}

std::string LaserScan(uint64_t time, const Scan& scan) {
  Cdr cdr;
  cdr.Header(time, scan.frame);
  cdr.Value(scan.angle_min);
  cdr.Value(scan.angle_min +
            scan.angle_step * static_cast<float>(scan.ranges.empty() ? 0 : scan.ranges.size() - 1));
  cdr.Value(scan.angle_step);
  cdr.Value(0.0F);
  cdr.Value(scan.period);
  cdr.Value(scan.range_min);
  cdr.Value(scan.range_max);
  cdr.Value<uint32_t>(static_cast<uint32_t>(scan.ranges.size()));
  for (const float r : scan.ranges) cdr.Value(r);
  cdr.Value<uint32_t>(0);
  return cdr.Take();
}

std::string MarkerArray(uint64_t time, const std::vector<Marker>& markers) {
  Cdr cdr;
  cdr.Value<uint32_t>(static_cast<uint32_t>(markers.size()));
  for (const Marker& m : markers) {
    cdr.Header(time, "world");
    cdr.Text(m.group);
    cdr.Value<int32_t>(m.id);
    cdr.Value<int32_t>(m.kind);
    cdr.Value<int32_t>(0);  // add
    cdr.ThePose(m.pose);
    for (const double x : m.size) cdr.Value(x);
    for (const float x : m.colour) cdr.Value(x);
    cdr.Value<int32_t>(0);  // for ever
    cdr.Value<uint32_t>(0);
    cdr.Value<uint8_t>(0);
    cdr.Value<uint32_t>(0);  // points
    cdr.Value<uint32_t>(0);  // colours
    cdr.Text("");
    cdr.Header(0, "");  // texture
    cdr.Text("");
    cdr.Value<uint32_t>(0);
    cdr.Value<uint32_t>(0);  // coordinates
    cdr.Text("");
    cdr.Text("");
    cdr.Text("");  // mesh file
    cdr.Value<uint32_t>(0);
    cdr.Value<uint8_t>(0);
  }
  return cdr.Take();
}

bool ReadPose(std::string_view bytes, Pose& pose) {
  Cursor c(bytes);
  if (!c.Take(uint64_t{4}) || !c.Take<int32_t>() || !c.Take<uint32_t>()) return false;
  const auto frame = c.TakeText();
  if (!frame) return false;
  const size_t used = 12 + frame->size();
  if (!c.Take(static_cast<uint64_t>((8 - used % 8) % 8))) return false;
  for (double* x : {&pose.position[0], &pose.position[1], &pose.position[2], &pose.rotation[0],
                    &pose.rotation[1], &pose.rotation[2], &pose.rotation[3]}) {
    const auto value = c.Take<double>();
    if (!value) return false;
    *x = *value;
  }
  return true;
}

}  // namespace rondo::trace
