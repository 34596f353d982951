// Any bytes as a message of each type that a robot reads: reading ends, and what is read is written and read again as the same.
#include <cstdint>

#include "deploy/echo.h"
#include "deploy/status.h"
#include "ros/discovery_info.h"
#include "ros/nav_msgs.h"
#include "ros/rondo_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/tf2_msgs.h"
#include "ros/visualization_msgs.h"

namespace {

using namespace rondo;

template <class M>
void Again(std::string_view bytes) {
  M message;
  if (!ros::Parse(bytes, message)) return;
  const std::string written = ros::Serialised(message);
  M again;
  if (!ros::Parse(written, again) || ros::Serialised(again) != written) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  Again<ros::nav_msgs::Odometry>(bytes);
  Again<ros::nav_msgs::Path>(bytes);
  Again<ros::sensor_msgs::LaserScan>(bytes);
  Again<ros::sensor_msgs::JointState>(bytes);
  Again<ros::tf2_msgs::TFMessage>(bytes);
  Again<ros::visualization_msgs::MarkerArray>(bytes);
  Again<ros::rondo_msgs::Datagram>(bytes);
  ros::DiscoveryInfo info;
  if (ros::Decode(bytes, info)) {
    ros::DiscoveryInfo again;
    if (!ros::Decode(ros::Encoded(info, false), again) || again.nodes.size() != info.nodes.size())
      __builtin_trap();
  }
  ros::diagnostic_msgs::DiagnosticArray diagnostics;
  if (ros::Parse(bytes, diagnostics)) (void)deploy::StatusesOf(diagnostics);
  (void)deploy::AnswerTo(bytes);
  return 0;
}
