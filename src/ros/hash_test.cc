#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "ros/action_msgs.h"
#include "ros/diagnostic_msgs.h"
#include "ros/discovery_info.h"
#include "ros/geometry_msgs.h"
#include "ros/nav_msgs.h"
#include "ros/px4_msgs.h"
#include "ros/rcl_interfaces.h"
#include "ros/sensor_msgs.h"
#include "ros/std_msgs.h"
#include "ros/tf2_msgs.h"
#include "ros/trajectory_msgs.h"
#include "ros/visualization_msgs.h"

namespace rondo::ros {
namespace {

// What rosidl computes for these types (ROS 2 Iron and later).
TEST(Hashes, AreThoseOfRos) {
  const std::vector<std::pair<const Message*, const char*>> golden = {
      {&std_msgs::String::kMessage, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
      {&std_msgs::Header::kMessage, "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"},
      {&std_msgs::Float64::kMessage, "705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a"},
      {&std_msgs::Bool::kMessage, "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
      {&geometry_msgs::Twist::kMessage, "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
      {&geometry_msgs::TwistStamped::kMessage,
       "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"},
      {&geometry_msgs::PoseStamped::kMessage,
       "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
      {&geometry_msgs::Pose2D::kMessage, "d68efa5b46e70f7b16ca23085474fdac5a44b638783ec42f661da64da4724ccc"},
      {&geometry_msgs::TransformStamped::kMessage,
       "0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206"},
      {&tf2_msgs::TFMessage::kMessage, "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {&nav_msgs::Odometry::kMessage, "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
      {&nav_msgs::Path::kMessage, "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"},
      {&sensor_msgs::LaserScan::kMessage, "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"},
      {&sensor_msgs::JointState::kMessage,
       "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
      {&kDiscoveryMessage, "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"},
      {&rcl_interfaces::Log::kMessage, "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"},
      {&builtin_interfaces::Time::kMessage,
       "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"}};
  for (const auto& [message, hash] : golden)
    EXPECT_EQ(message->hash, std::string("RIHS01_") + hash) << message->name;
}

TEST(Definitions, NameWhatTheyUseOnce) {
  const std::string text(geometry_msgs::TwistStamped::kMessage.definition);
  EXPECT_EQ(text.substr(0, 40), "std_msgs/Header header\nTwist twist\n=====");
  for (const char* used : {"MSG: std_msgs/Header\n", "MSG: builtin_interfaces/Time\n",
                           "MSG: geometry_msgs/Twist\n", "MSG: geometry_msgs/Vector3\n"}) {
    const size_t at = text.find(used);
    EXPECT_NE(at, std::string::npos) << used;
    EXPECT_EQ(text.find(used, at + 1), std::string::npos) << used;
  }
}

}  // namespace
}  // namespace rondo::ros
