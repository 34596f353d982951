#include "ros/cdr.h"

#include <gtest/gtest.h>

#include <random>

#include "ros/discovery_info.h"
#include "ros/names.h"
#include "ros/nav_msgs.h"
#include "ros/rmw_dds_common.h"
#include "ros/sensor_msgs.h"
#include "ros/std_msgs.h"
#include "ros/visualization_msgs.h"

namespace rondo::ros {
namespace {

std::string Hex(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    text += kDigits[static_cast<unsigned char>(c) >> 4];
    text += kDigits[static_cast<unsigned char>(c) & 15];
  }
  return text;
}

// By hand, from the rules: each value at a multiple of its size, counted behind the header.
TEST(Cdr, ValuesStandAtMultiplesOfTheirSizes) {
  CdrWriter w;
  w.Value(uint8_t{1});
  w.Value(uint16_t{2});
  w.Value(std::string_view("ab"));
  w.Value(1.0);
  EXPECT_EQ(Hex(w.Take()),
            "00010000"
            "01"
            "00"
            "0200"
            "03000000"
            "616200"
            "0000000000"
            "000000000000f03f");
}

TEST(Cdr, AMessageInBigEndianIsRead) {
  using namespace std::string_literals;
  sensor_msgs::JointState m;
  const std::string bytes =
      "\0\0\0\0"s
      "\0\0\0\1"s
      "\0\0\0\2"s
      "\0\0\0\2x\0"s
      "\0\0"s
      "\0\0\0\1"s
      "\0\0\0\2j\0"s
      "\0\0"s
      "\0\0\0\1"s
      "\x3f\xf0\0\0\0\0\0\0"s
      "\0\0\0\0"s
      "\0\0\0\0"s;
  ASSERT_TRUE(Parse(bytes, m)) << Hex(bytes);
  EXPECT_EQ(m.header.stamp.sec, 1);
  EXPECT_EQ(m.header.stamp.nanosec, 2U);
  EXPECT_EQ(m.header.frame_id, "x");
  EXPECT_EQ(m.name, std::vector<std::string>{"j"});
  EXPECT_EQ(m.position, std::vector<double>{1.0});
}

nav_msgs::Path SomePath() {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  for (int i = 0; i < 3; ++i) {
    auto& pose = path.poses.emplace_back();
    pose.header.frame_id = std::string(static_cast<size_t>(i), 'x');
    pose.pose.position.y = i;
  }
  return path;
}

TEST(Cdr, WhatIsWrittenIsRead) {
  const std::string bytes = Serialised(SomePath());
  nav_msgs::Path path;
  ASSERT_TRUE(Parse(bytes, path));
  EXPECT_EQ(Serialised(path), bytes);
  std_msgs::Empty nothing;
  EXPECT_EQ(Hex(Serialised(nothing)), "0001000000");
  EXPECT_TRUE(Parse(Serialised(nothing), nothing));
}

TEST(Cdr, WhatIsCutOffOrTooLongIsNoMessage) {
  const std::string bytes = Serialised(SomePath());
  nav_msgs::Path path;
  for (size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(Parse(bytes.substr(0, n), path)) << n;
  EXPECT_TRUE(Parse(bytes + std::string(3, '\0'), path));  // padding
  EXPECT_FALSE(Parse(bytes + std::string(8, '\0'), path));
}

// Whatever the bytes are, no more memory is taken than they account for.
TEST(Cdr, DamagedMessagesAreRefusedOrRead) {
  std::mt19937 random(1);
  const std::string bytes = Serialised(SomePath());
  for (int i = 0; i < 20'000; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    nav_msgs::Path path;
    if (Parse(damaged, path)) {
      EXPECT_LE(path.poses.size() * 70, damaged.size());
    }
    visualization_msgs::MarkerArray markers;
    Parse(damaged, markers);
  }
}

DiscoveryInfo SomeInfo() {
  DiscoveryInfo info;
  info.participant = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 1, 0xc1};
  info.nodes.push_back({"/", "driver", {info.participant}, {}});
  info.nodes.push_back({"/robot1", "rondo", {info.participant, {}}, {info.participant}});
  return info;
}

TEST(DiscoveryInfo, IsReadInBothSizes) {
  for (const bool old : {false, true}) {
    const std::string bytes = Encoded(SomeInfo(), old);
    DiscoveryInfo info;
    ASSERT_TRUE(Decode(bytes, info)) << old;
    EXPECT_EQ(Encoded(info, old), bytes);
    EXPECT_EQ(info.nodes.size(), 2U);
    EXPECT_EQ(info.nodes[1].node_namespace, "/robot1");
    EXPECT_EQ(info.nodes[1].readers.size(), 2U);
  }
  EXPECT_NE(Encoded(SomeInfo(), false).size(), Encoded(SomeInfo(), true).size());
}

TEST(DiscoveryInfo, IsTheMessageOfItsDefinition) {
  rmw_dds_common::ParticipantEntitiesInfo m;
  const std::string bytes = Encoded(SomeInfo(), false);
  ASSERT_TRUE(Parse(bytes, m));
  EXPECT_EQ(m.node_entities_info_seq[1].node_name, "rondo");
  EXPECT_EQ(Serialised(m), bytes);
}

TEST(Names, OnTheWireAndBack) {
  EXPECT_EQ(WireTopic("/robot1/odom"), "rt/robot1/odom");
  EXPECT_EQ(WireType("geometry_msgs/msg/Twist"), "geometry_msgs::msg::dds_::Twist_");
  EXPECT_EQ(TopicOfWire("rt/robot1/odom"), "/robot1/odom");
  EXPECT_EQ(TopicOfWire("rq/robot1/serviceRequest"), "");
  EXPECT_EQ(TypeOfWire("geometry_msgs::msg::dds_::Twist_"), "geometry_msgs/msg/Twist");
  EXPECT_EQ(TypeOfWire("Twist"), "");
  EXPECT_EQ(FullName("/robot1", "odom"), "/robot1/odom");
  EXPECT_EQ(FullName("/", "odom"), "/odom");
  EXPECT_EQ(FullName("robot1", "/tf"), "/tf");
  for (const char* good : {"odom", "/odom", "/a/b_c/d1", "_x"}) EXPECT_TRUE(IsName(good)) << good;
  for (const char* bad : {"", "/", "a//b", "1a", "a/1", "a__b", "a/", "a-b", "a b"})
    EXPECT_FALSE(IsName(bad)) << bad;
}

}  // namespace
}  // namespace rondo::ros
