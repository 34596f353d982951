#include "sim/fleet/fleet.h"

#include <gtest/gtest.h>

namespace rondo::sim {
namespace {

const std::string kRobot = "[[robot]]\nmodel = \"car\"\nposition = [0, 0, 0]\n";

struct Reading {
  explicit Reading(const std::string& text) {
    fleet = ReadFleet(sources, sources.Add("f.toml", text), diagnostics);
  }
  // `text under the span: message` of the only diagnostic.
  std::string Mistake() const {
    EXPECT_EQ(diagnostics.all().size(), 1U);
    if (diagnostics.all().empty()) return "";
    const diag::Diagnostic& d = diagnostics.all()[0];
    EXPECT_EQ(d.severity, diag::Severity::kError);
    return std::string(sources.Text(d.span)) + ": " + d.message;
  }

  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  Fleet fleet;
};

// The mistake in a file that has a robot besides.
std::string MistakeIn(const std::string& text) { return Reading(text + "\n" + kRobot).Mistake(); }

TEST(Fleet, HasDefaults) {
  const Reading reading(kRobot);
  EXPECT_TRUE(reading.diagnostics.all().empty());
  EXPECT_EQ(reading.fleet.delta, 0.1);
  EXPECT_EQ(reading.fleet.duration, 60);
  EXPECT_EQ(reading.fleet.policy, Policy::kFirst);
  EXPECT_EQ(reading.fleet.integrator, Integrator::kRungeKutta4);
  EXPECT_FALSE(reading.fleet.seed.has_value());
  EXPECT_EQ(reading.fleet.world.high, (Point{50, 50, 20}));
  ASSERT_EQ(reading.fleet.robots.size(), 1U);
  EXPECT_EQ(reading.fleet.robots[0].name, "robot0");
}

TEST(Fleet, ReadsEverySection) {
  const Reading reading(
      "[run]\ndelta = 0.5\nduration = 3\nskip = 0.25\nseed = 9\npolicy = \"round_robin\"\nintegrator = \"adaptive\"\n"
      "until = \"mapped\"\n[world]\nlow = [-1, -2, 0]\nhigh = [1, 2, 3]\n"
      "[[world.cylinder]]\ncentre = [0, 1, 0]\nradius = 0.25\nheight = 4\n"
      "[lidar]\nbeams = 12\nnoise = 0.5\n[map]\ncell = 2\n[planner]\npath_clearance = 1.5\n" +
      kRobot);
  EXPECT_TRUE(reading.diagnostics.all().empty());
  const Fleet& fleet = reading.fleet;
  EXPECT_EQ(fleet.delta, 0.5);
  EXPECT_EQ(fleet.skip, 0.25);
  EXPECT_EQ(fleet.seed, 9U);
  EXPECT_EQ(fleet.policy, Policy::kRoundRobin);
  EXPECT_EQ(fleet.integrator, Integrator::kAdaptive);
  EXPECT_EQ(fleet.until, Until::kMapped);
  EXPECT_EQ(fleet.world.low, (Point{-1, -2, 0}));
  ASSERT_EQ(fleet.world.cylinders.size(), 1U);
  EXPECT_EQ(fleet.world.cylinders[0].radius, 0.25);
  EXPECT_EQ(fleet.lidar.beams, 12);
  EXPECT_EQ(fleet.lidar.noise, 0.5);
  EXPECT_EQ(fleet.cell, 2);
  EXPECT_EQ(fleet.path_clearance, 1.5);
}

TEST(Fleet, ManyRobotsStandInRows) {
  const Reading reading(kRobot +
                        "name = \"r\"\ncount = 5\ncolumns = 2\nstep = [2, 0, 0]\nrow_step = [0, 3, 1]\n");
  ASSERT_EQ(reading.fleet.robots.size(), 5U);
  EXPECT_EQ(reading.fleet.robots[1].name, "r1");
  EXPECT_EQ(reading.fleet.robots[1].position, (Point{2, 0, 0}));
  EXPECT_EQ(reading.fleet.robots[4].position, (Point{0, 6, 2}));
}

TEST(Fleet, ParametersOfAModelAreNumbers) {
  const Reading reading(kRobot + "parameters = { wheelbase = 0.5 }\nyaw = 1.5\n");
  EXPECT_EQ(reading.fleet.robots[0].parameters.at("wheelbase"), 0.5);
  EXPECT_EQ(reading.fleet.robots[0].yaw, 1.5);
}

TEST(Fleet, ValuesOfTheProgramKeepTheirTypes) {
  const Reading reading("[params]\na = 1\nb = 1.0\nc = true\nd = \"text\"\n[initial]\nl = [{ id = 1 }]\n" +
                        kRobot);
  const auto& params = reading.fleet.params;
  EXPECT_TRUE(params.at("a").value.is_number_integer());
  EXPECT_TRUE(params.at("b").value.is_number_float());
  EXPECT_TRUE(params.at("c").value.is_boolean());
  EXPECT_EQ(params.at("d").value, "text");
  EXPECT_EQ(reading.fleet.initial.at("l").value, nlohmann::json::array({{{"id", 1}}}));
  EXPECT_EQ(reading.sources.Text(params.at("a").span), "1");
}

TEST(Fleet, WhatIsNoTomlIsASyntaxError) {
  const Reading reading("[run\ndelta = 1\n");
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].kind, diag::Kind::kFleetSyntax);
  EXPECT_EQ(
      reading.sources.Locate(reading.diagnostics.all()[0].span.file, reading.diagnostics.all()[0].span.begin)
          .line,
      1U);
}

TEST(Fleet, AnUnknownKeyIsAMistake) {
  EXPECT_EQ(MistakeIn("[run]\ndelta = 1\nduraton = 3"), "duraton = 3: `run` has no `duraton`");
  EXPECT_EQ(MistakeIn("[worlds]"), "worlds]: a fleet file has no `worlds`");
}

TEST(Fleet, AnUnknownKeyThatIsNearlyRightHasAHint) {
  const Reading reading("[run]\nduraton = 3\n" + kRobot);
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].helps, std::vector<std::string>{"did you mean `duration`?"});
}

TEST(Fleet, ANumberMustBeOne) {
  EXPECT_EQ(MistakeIn("[run]\ndelta = \"long\""), "\"long\": `delta` must be a number");
  EXPECT_EQ(MistakeIn("[run]\ndelta = true"), "true: `delta` must be a number");
  EXPECT_EQ(MistakeIn("[run]\ndelta = inf"), "inf: `delta` must be a number");
}

TEST(Fleet, ANumberMustLieInItsRange) {
  EXPECT_EQ(MistakeIn("[run]\nskip = 1.5"), "1.5: `skip` must lie between 0 and 1");
  EXPECT_EQ(MistakeIn("[run]\nskip = -0.5"), "-0.5: `skip` must lie between 0 and 1");
  EXPECT_EQ(Reading("[run]\nskip = 1\n" + kRobot).fleet.skip, 1);
}

TEST(Fleet, AMistakeLeavesTheDefault) { EXPECT_EQ(Reading("[run]\ndelta = -1\n" + kRobot).fleet.delta, 0.1); }

TEST(Fleet, ANumberThatADoubleCannotHoldIsAMistake) {
  EXPECT_EQ(MistakeIn("[run]\ndelta = 1e-400"), "1e-400: this number is too large or too small to be read");
}

TEST(Fleet, AWordMustBeOneOfTheChoices) {
  EXPECT_EQ(MistakeIn("[run]\npolicy = \"last\""), "\"last\": `policy` cannot be this");
  EXPECT_EQ(MistakeIn("[run]\nuntil = 3"), "3: `until` cannot be this");
}

TEST(Fleet, ASectionMustBeATable) {
  EXPECT_EQ(MistakeIn("run = 3"), "3: `run` must be a table: `[run]`");
  EXPECT_EQ(Reading("robot = 3\n[[world.box]]\ncentre = [0, 0, 0]\nsize = [1, 1, 1]\n").Mistake(),
            "3: write `[[robot]]` for each");
}

TEST(Fleet, APointHasThreeNumbers) {
  EXPECT_EQ(Reading("[world]\nlow = 3\n" + kRobot).Mistake(), "3: `low` must be three numbers: `[x, y, z]`");
  const Reading two("[world]\nlow = [0, 0]\n" + kRobot);
  ASSERT_EQ(two.diagnostics.all().size(), 1U);
  EXPECT_EQ(two.diagnostics.all()[0].message, "`low` must be three numbers: `[x, y, z]`");
  EXPECT_EQ(MistakeIn("[world]\nlow = [0, 2000000, 0]"), "2000000: `low` needs numbers below a million");
}

TEST(Fleet, TheWorldIsNotUpsideDown) {
  const Reading reading("[world]\nlow = [0, 0, 5]\nhigh = [1, 1, 4]\n" + kRobot);
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].message, "`high` must not be below `low`");
}

TEST(Fleet, ABoxHasASize) {
  const Reading reading("[[world.box]]\ncentre = [0, 0, 0]\nsize = [1, 0, 1]\n" + kRobot);
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].message, "a box needs a positive size in every direction");
}

TEST(Fleet, ARobotHasAModel) {
  EXPECT_EQ(Reading("[[robot]]\nmodel = \"quadroto\"\nposition = [0, 0, 0]\n").Mistake(),
            "\"quadroto\": there is no model `quadroto`");
  const Reading none("[[robot]]\nposition = [0, 0, 0]\n");
  ASSERT_EQ(none.diagnostics.all().size(), 1U);
  EXPECT_EQ(none.diagnostics.all()[0].message, "the robot has no `model`");
}

TEST(Fleet, ARobotHasAPosition) {
  const Reading reading("[[robot]]\nmodel = \"car\"\n");
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].message, "`position` is missing");
}

TEST(Fleet, OnlyParametersOfTheModelCanBeSet) {
  EXPECT_EQ(Reading(kRobot + "parameters = { mass = 1 }\n").Mistake().substr(0, 4), "mass");
  EXPECT_EQ(Reading(kRobot + "parameters = { radius = 0 }\n").diagnostics.all().size(), 1U);
  EXPECT_TRUE(Reading(kRobot + "parameters = { dwell = 0 }\n").diagnostics.all().empty());
}

TEST(Fleet, NamesAreWordsAndDiffer) {
  EXPECT_EQ(Reading(kRobot + "name = \"a b\"\n").Mistake(), "\"a b\": a name has letters, digits and `_`");
  const Reading twice(kRobot + "name = \"a\"\n" + kRobot + "name = \"a\"\n");
  ASSERT_EQ(twice.diagnostics.all().size(), 1U);
  EXPECT_EQ(twice.diagnostics.all()[0].message, "there are two robots `a`");
}

TEST(Fleet, ACountIsWhole) {
  EXPECT_EQ(Reading(kRobot + "count = 1.5\n").Mistake(), "1.5: `count` must be a whole number");
  EXPECT_EQ(Reading(kRobot + "count = 0\n").Mistake(), "0: `count` must lie between 1 and 100000");
}

TEST(Fleet, WithoutARobotThereIsNothingToSimulate) {
  const Reading reading("[run]\ndelta = 1\n");
  ASSERT_EQ(reading.diagnostics.all().size(), 1U);
  EXPECT_EQ(reading.diagnostics.all()[0].message, "the fleet has no robot");
}

TEST(Fleet, SaysHowRobotsAreReached) {
  const Reading reading(R"(
[ros]
domain = 7
profile = "wifi"
interface = "wlan0"
distribution = "humble"
frame = "hall"
[ports]
psn = { ros2 = "odom", max_age = 0.2 }
target = { cmd_vel = "/all/cmd_vel", stamped = true }
[[robot]]
name = "a"
model = "car"
position = [0, 0, 0]
address = "10.0.0.1"
namespace = "/hall/a"
)");
  EXPECT_TRUE(reading.diagnostics.all().empty());
  const FleetRos& ros = reading.fleet.ros;
  EXPECT_EQ(ros.network.domain, 7U);
  EXPECT_EQ(ros.network.profile, dds::Profile::kWifi);
  EXPECT_EQ(ros.network.interface, "wlan0");
  EXPECT_TRUE(ros.network.old_identities);
  EXPECT_EQ(ros.frame, "hall");
  EXPECT_EQ(ros.ports.at("psn").max_age, 0.2);
  EXPECT_EQ(ros.ports.at("target").via, PortVia::kTwist);
  EXPECT_TRUE(ros.ports.at("target").stamped);
  EXPECT_EQ(reading.fleet.robots[0].address, "10.0.0.1");
  EXPECT_EQ(reading.fleet.robots[0].node_namespace, "hall/a");
  EXPECT_EQ(Reading(kRobot).fleet.robots[0].node_namespace, "robot0");
}

TEST(Fleet, PortsMayBeJointsAutopilotsAndLibraries) {
  const Reading reading(R"(
[ros]
use_sim_time = true
keys = "keys"
[ports]
psn = { px4 = "fmu", system = 3 }
reached = { nav2 = "navigate_to_pose/_action/status" }
elbow = { joint_states = "joint_states", joint = "elbow_joint", reliable = true, transient_local = true, depth = 3 }
bend = { joint_trajectory = "arm/joint_trajectory", joint = "elbow_joint", within = 0.5 }
charge = { adapter = "./libbattery.so", with = "/dev/ttyUSB0" }
heading = { tf = "base_link" }
position = { pose = "amcl_pose", with_covariance = true }
[[robot]]
name = "a"
model = "car"
position = [1, 2, 0]
yaw = 0.5
count = 2
origin = "start"
[[robot]]
name = "b"
model = "car"
position = [9, 9, 0]
origin = [1, 2, 3]
)");
  EXPECT_TRUE(reading.diagnostics.all().empty());
  const FleetRos& ros = reading.fleet.ros;
  EXPECT_TRUE(ros.use_sim_time);
  EXPECT_EQ(ros.keys, "keys");
  EXPECT_EQ(ros.ports.at("psn").via, PortVia::kPx4);
  EXPECT_EQ(ros.ports.at("psn").system, 3);
  EXPECT_FALSE(ros.ports.at("psn").reliable.has_value());
  EXPECT_EQ(ros.ports.at("reached").via, PortVia::kNav2);
  const FleetPort& elbow = ros.ports.at("elbow");
  EXPECT_EQ(elbow.joint, "elbow_joint");
  EXPECT_EQ(elbow.reliable, true);
  EXPECT_EQ(elbow.transient_local, true);
  EXPECT_EQ(elbow.depth, 3U);
  EXPECT_EQ(ros.ports.at("bend").within, 0.5);
  EXPECT_EQ(ros.ports.at("charge").via, PortVia::kAdapter);
  EXPECT_EQ(ros.ports.at("heading").via, PortVia::kTransform);
  EXPECT_EQ(ros.ports.at("position").via, PortVia::kPose);
  EXPECT_TRUE(ros.ports.at("position").with_covariance);
  EXPECT_EQ(ros.ports.at("charge").options, "/dev/ttyUSB0");
  // Each begins where it starts.
  EXPECT_EQ(reading.fleet.robots[1].origin->position, (Point{2, 2, 0}));
  EXPECT_EQ(reading.fleet.robots[1].origin->yaw, 0.5);
  EXPECT_EQ(reading.fleet.robots[2].origin->position, (Point{1, 2, 3}));
  EXPECT_FALSE(Reading(kRobot).fleet.robots[0].origin.has_value());
}

TEST(Fleet, MistakesAboutTopicsHaveAPlace) {
  EXPECT_NE(
      MistakeIn("[ports]\nelbow = { joint_states = \"a\" }").find(": `elbow` needs the name of its joint"),
      std::string::npos);
  EXPECT_NE(
      MistakeIn("[ports]\npsn = { px4 = \"a\", stamped = true }").find("a port by `px4` has no `stamped`"),
      std::string::npos);
  EXPECT_EQ(Reading("[[robot]]\nmodel = \"car\"\nposition = [0, 0, 0]\norigin = \"home\"\n").Mistake(),
            "\"home\": `origin` must be a point, `[x, y, z]`, or \"start\"");
  EXPECT_EQ(MistakeIn("[ros]\ndomain = 300"), "300: `domain` must lie between 0 and 232");
  EXPECT_EQ(MistakeIn("[ros]\nprofile = \"radio\""), "\"radio\": `profile` cannot be this");
  EXPECT_EQ(MistakeIn("[ports]\npsn = \"odom\""),
            "\"odom\": `psn` needs a topic, as in { ros2 = \"odom\" } or { cmd_vel = \"cmd_vel\" }");
  // The places of values in tables of one line end where the library says.
  EXPECT_NE(MistakeIn("[ports]\npsn = { ros2 = \"1odom\" }").find(": a topic has letters, digits"),
            std::string::npos);
  EXPECT_NE(MistakeIn("[ports]\npsn = { ros2 = \"a\", nav2 = \"b\" }")
                .find(": `psn` has two topics: `ros2` and `nav2`"),
            std::string::npos);
  EXPECT_EQ(
      Reading("[[robot]]\nmodel = \"car\"\nposition = [0, 0, 0]\ncount = 2\naddress = \"a\"\n").Mistake(),
      "\"a\": `address` is of one robot: it does not go with `count`");
}

}  // namespace
}  // namespace rondo::sim
