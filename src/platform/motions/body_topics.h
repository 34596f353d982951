#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/model/world.h"
#include "sim/motions/scene_state.h"

/// Connects robots of choreographies with topics of ROS 2.
namespace rondo::platform {

/// Says which states of a robot are where its base stands, by their places in a scene: in the frame where the world puts it.
struct Base {
  size_t x = 0, y = 0;
  std::optional<size_t> yaw;  ///< nothing: it never turns
  double heading = 0;         ///< the middle of what that can be: radians
};

/// Is a joint: any other state of a robot.
struct Joint {
  std::string name;  ///< of the state
  size_t place = 0;  ///< in a scene
};

/// Is what only a sensor can know: a topic with a number.
struct Signal {
  std::string topic;
  size_t place = 0;  ///< in a scene
};

/// Says on which topics a robot tells where it is, and is told where to go. All lie in its namespace.
///
/// `odom` (nav_msgs/Odometry) and `cmd_vel` (geometry_msgs/Twist) for a base, in its own frame; `joint_states`
/// (sensor_msgs/JointState) and `joint_trajectory` (trajectory_msgs/JointTrajectory) for joints, by the names of the states;
/// `events` (std_msgs/String, JSON) for what its session does; `NAME` (std_msgs/Float64) for each signal.
struct BodyTopics {
  std::string node_namespace;  ///< without `/`: the robot's name, as a part of a name of ROS
  std::optional<Base> base;
  std::vector<Joint> joints;
  std::vector<Signal> signals;
  std::string Full(std::string_view topic) const { return "/" + node_namespace + "/" + std::string(topic); }
};

/// Returns the topics of a robot. A robot has a base if two of its states are lengths called `x` and `y`; an angle `theta` or
/// `yaw` is its heading then. If that has a range of more than a full turn, no orientation tells it, and all of them are joints.
/// Its signals are its parameters without a value, and those of its inputs that its dynamics do not
/// read: the others are what moves it, or disturbs that.
BodyTopics TopicsOf(const robot::World& world, size_t robot, const expr::Arena& arena,
                    const sim::motions::SceneState& scene);

/// Returns the signals of the environment: `/environment/PART/NAME`.
std::vector<Signal> EnvironmentOf(const robot::World& world, const expr::Arena& arena,
                                  const sim::motions::SceneState& scene);

/// Says which two things of a world would have one topic, because ROS has no other names for them; empty if there are none.
std::string Collision(const robot::World& world, const expr::Arena& arena,
                      const sim::motions::SceneState& scene);

}  // namespace rondo::platform
