// A lifecycle node of a robot that is not active: it would say where the robot is, and says nothing.
//
//   sleeping_node DOMAIN NAMESPACE SECONDS
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "dds/participant.h"
#include "ros/nav_msgs.h"
#include "ros/std_msgs.h"

int main(int, char** arguments) {
  using namespace rondo;
  dds::Network network;
  network.domain = static_cast<uint32_t>(std::atoi(arguments[1]));
  const std::string space = std::string("/") + arguments[2];
  const auto participant = dds::Participant::Open(network);
  if (!participant.ok()) return 1;
  const size_t node = participant.value()->AddNode({space, "localizer"});
  const auto odom =
      participant.value()->Publish(node, space + "/odom", ros::nav_msgs::Odometry::kMessage, {});
  // Its type is lifecycle_msgs/TransitionEvent; nobody reads it.
  const auto changes = participant.value()->Publish(node, space + "/localizer/transition_event",
                                                    ros::std_msgs::String::kMessage, {});
  if (!odom.ok() || !changes.ok()) return 1;
  std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(arguments[3])));
  return 0;
}
