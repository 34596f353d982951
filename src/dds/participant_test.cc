#include "dds/participant.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <cstdlib>

#include "dds/domain_test.h"
#include "dds/sockets.h"
#include "ros/geometry_msgs.h"
#include "ros/std_msgs.h"

namespace rondo::dds {
namespace {

std::unique_ptr<Participant> Opened(const Network& network = TestNetwork()) {
  auto participant = Participant::Open(network);
  EXPECT_TRUE(participant.ok()) << participant.error().message;
  return std::move(participant).value();
}

TEST(Participant, MessagesArriveWhole) {
  const auto a = Opened(), b = Opened();
  const size_t from = a->AddNode({"/robot1", "talker"}), to = b->AddNode({"/robot2", "listener"});
  std::mutex mutex;
  std::vector<std::string> heard;
  auto reader = b->Subscribe(to, "/chatter", ros::std_msgs::String::kMessage, {.depth = 0},
                             [&](std::string_view bytes, const Received& received) {
                               ros::std_msgs::String message;
                               const std::lock_guard lock(mutex);
                               if (ros::Parse(bytes, message)) heard.push_back(message.data);
                               EXPECT_GT(received.stamp, 1'600'000'000'000'000'000);
                             });
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  auto writer = a->Publish(from, "/chatter", ros::std_msgs::String::kMessage, {.depth = 0});
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  ASSERT_TRUE(Eventually([&] { return writer.value()->matched() == 1 && reader.value()->matched() == 1; }));
  std::vector<std::string> said;
  for (const size_t size : {0U, 1U, 2U, 3U, 4U, 1000U, 300'000U}) {
    ros::std_msgs::String message;
    message.data = std::string(size, 'x');
    said.push_back(message.data);
    EXPECT_TRUE(writer.value()->Publish(message).ok());
  }
  EXPECT_TRUE(Eventually([&] {
    const std::lock_guard lock(mutex);
    return heard.size() == said.size();
  }));
  EXPECT_EQ(heard, said);
}

TEST(Participant, WhoComesLateGetsTheLastOnes) {
  const auto a = Opened(), b = Opened();
  const size_t from = a->AddNode({"/", "maps"}), to = b->AddNode({"/", "viewer"});
  auto writer = a->Publish(from, "/map_name", ros::std_msgs::String::kMessage, ros::kLatched);
  ASSERT_TRUE(writer.ok());
  for (const char* text : {"old", "new"}) {
    ros::std_msgs::String message;
    message.data = text;
    EXPECT_TRUE(writer.value()->Publish(message).ok());
  }
  std::mutex mutex;
  std::vector<std::string> heard;
  const auto reader = b->Subscribe(to, "/map_name", ros::std_msgs::String::kMessage, ros::kLatched,
                                   [&](std::string_view bytes, const Received&) {
                                     ros::std_msgs::String message;
                                     const std::lock_guard lock(mutex);
                                     if (ros::Parse(bytes, message)) heard.push_back(message.data);
                                   });
  EXPECT_TRUE(Eventually([&] {
    const std::lock_guard lock(mutex);
    return !heard.empty();
  }));
  EXPECT_EQ(heard, std::vector<std::string>{"new"});
}

TEST(Participant, SeesNodesAndTopicsOfOthersInBothSizesOfIdentities) {
  for (const bool old : {false, true}) {
    Network network = TestNetwork();
    network.old_identities = old;
    const auto a = Opened(network), b = Opened();
    const size_t node = a->AddNode({"/robot1", "rondo"});
    const auto writer =
        a->Publish(node, "/robot1/cmd_vel", ros::geometry_msgs::Twist::kMessage, ros::kSensorData);
    ASSERT_TRUE(writer.ok());
    EXPECT_TRUE(Eventually([&] {
      const auto nodes = b->Nodes();
      const auto found = std::ranges::find(nodes, NodeName{"/robot1", "rondo"}, &Participant::Node::name);
      return found != nodes.end() && found->participant == a->guid() && found->writers.size() == 1;
    })) << old;
    std::vector<Endpoint> found;
    EXPECT_TRUE(Eventually([&] {
      found = b->Endpoints();
      std::erase_if(found, [](const Endpoint& e) { return e.topic != "/robot1/cmd_vel"; });
      return !found.empty();
    }));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found[0].writes);
    EXPECT_EQ(found[0].type, "geometry_msgs/msg/Twist");
    EXPECT_EQ(found[0].hash, ros::geometry_msgs::Twist::kMessage.hash);
    EXPECT_FALSE(found[0].qos.reliable);
    EXPECT_EQ(found[0].participant, a->guid());
  }
}

TEST(Participant, WhoIsGoneIsNotListed) {
  const auto b = Opened();
  {
    const auto a = Opened();
    a->AddNode({"/", "passing"});
    EXPECT_TRUE(Eventually([&] { return b->Nodes().size() == 1; }));
  }
  EXPECT_TRUE(Eventually([&] { return b->Nodes().empty(); }));
}

// A network that stands still does not stop who sends.
TEST(Participant, SendingWaitsForAMillisecondAtMost) {
  const auto before = DatagramSockets();
  const auto a = Opened();
  size_t fresh = 0;
  for (const int fd : DatagramSockets()) {
    if (before.contains(fd)) continue;
    ++fresh;
    timeval limit{};
    socklen_t size = sizeof(limit);
    EXPECT_EQ(::getsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, &size), 0);
    EXPECT_EQ(limit.tv_sec, 0);
    EXPECT_GT(limit.tv_usec, 0);
    EXPECT_LE(limit.tv_usec, 10'000);
  }
  EXPECT_GT(fresh, 1U);
}

// Errors are told in the words of the library, which knows the names of interfaces.
TEST(Participant, AnInterfaceThatDoesNotExistIsAnError) {
  Network network = TestNetwork();
  network.domain = 5;  // the library configures a domain once
  network.profile = Profile::kLan;
  network.interface = "nosuch0";
  const auto participant = Participant::Open(network);
  ASSERT_FALSE(participant.ok());
  EXPECT_NE(participant.error().message.find("nosuch0"), std::string::npos) << participant.error().message;
}

class Variables : public testing::Test {
 protected:
  void Set(const char* name, const char* value) {
    ::setenv(name, value, 1);
    set_.emplace_back(name);
  }
  ~Variables() override {
    for (const std::string& name : set_) ::unsetenv(name.c_str());
  }
  std::vector<std::string> set_;
};

TEST_F(Variables, OfRosAreObeyed) {
  Set("ROS_DOMAIN_ID", "42");
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET");
  Set("ROS_STATIC_PEERS", "10.0.0.1;10.0.0.2");
  Set("ROS_DISTRO", "humble");
  const auto network = WithEnvironment({});
  ASSERT_TRUE(network.ok());
  EXPECT_EQ(network.value().domain, 42U);
  EXPECT_EQ(network.value().profile, Profile::kLan);
  EXPECT_EQ(network.value().peers, (std::vector<std::string>{"10.0.0.1", "10.0.0.2"}));
  EXPECT_TRUE(network.value().old_identities);
  Set("ROS_LOCALHOST_ONLY", "1");
  Set("ROS_AUTOMATIC_DISCOVERY_RANGE", "");
  EXPECT_EQ(WithEnvironment(network.value()).value().profile, Profile::kLoopback);
}

TEST_F(Variables, WithValuesThatTheyCannotHaveAreErrors) {
  for (const char* bad : {"-1", "233", "x", "4x"}) {
    Set("ROS_DOMAIN_ID", bad);
    EXPECT_FALSE(WithEnvironment({}).ok()) << bad;
  }
  Set("ROS_DOMAIN_ID", "");
  for (const char* bad : {"OFF", "WORLD"}) {
    Set("ROS_AUTOMATIC_DISCOVERY_RANGE", bad);
    EXPECT_FALSE(WithEnvironment({}).ok()) << bad;
  }
}

}  // namespace
}  // namespace rondo::dds
