#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "koord/check/model.h"
#include "ros/geometry_msgs.h"
#include "ros/message.h"
#include "ros/qos.h"
#include "ros/std_msgs.h"
#include "sim/ports.h"

/// Connects the ports of programs with topics of ROS 2.
namespace rondo::platform {

/// Names what a topic carries.
enum class Carries : uint8_t {
  kOdometry,         ///< nav_msgs/Odometry: where the robot is, and how fast
  kScan,             ///< sensor_msgs/LaserScan
  kPose,             ///< geometry_msgs/PoseStamped: where to go
  kPath,             ///< nav_msgs/Path: which way to go
  kBool,             ///< std_msgs/Bool
  kNumber,           ///< std_msgs/Float64
  kPoint,            ///< geometry_msgs/Point
  kTwist,            ///< geometry_msgs/Twist: how to move; the robot's node has the controller
  kTwistStamped,     ///< geometry_msgs/TwistStamped: the same
  kAckermann,        ///< ackermann_msgs/AckermannDriveStamped: the same
  kGoalStatus,       ///< action_msgs/GoalStatusArray: what became of goals
  kPoseSeen,         ///< geometry_msgs/PoseStamped: where the robot is
  kCovariance,       ///< geometry_msgs/PoseWithCovarianceStamped: the same
  kTransform,        ///< tf2_msgs/TFMessage: where a frame of the robot is
  kJointState,       ///< sensor_msgs/JointState: where a joint is
  kJointTrajectory,  ///< trajectory_msgs/JointTrajectory: where a joint is to be
  kPx4Odometry,      ///< px4_msgs/VehicleOdometry: as kOdometry
  kPx4Setpoint,  ///< px4_msgs/TrajectorySetpoint: where to fly; the robot's node has what PX4 wants to hear besides
};

/// Reports whether a topic carries how to move, from moment to moment.
constexpr bool Drives(Carries carries) {
  return carries == Carries::kTwist || carries == Carries::kTwistStamped || carries == Carries::kAckermann;
}

/// Reports whether a topic says where the robot is.
constexpr bool SaysPlace(Carries carries) {
  return carries == Carries::kOdometry || carries == Carries::kPx4Odometry || carries == Carries::kPoseSeen ||
         carries == Carries::kCovariance || carries == Carries::kTransform;
}

/// Says on which topic a port is.
struct Topic {
  std::string port;  ///< its name in the program, without the module
  std::string name;  ///< in full, with the namespace of the robot
  Carries carries = Carries::kNumber;
  double max_age = 0;            ///< of a sensor, in seconds
  ros::Qos qos;                  ///< of the robot's node
  std::string frame;             ///< of kTransform
  std::string joint;             ///< of kJointState and kJointTrajectory
  double within = 0;             ///< of kJointTrajectory, in seconds
  uint8_t system = 1;            ///< of kPx4Setpoint: the number of the autopilot
  std::string library, options;  ///< of the user's adapter, which stands for the topic; empty: there is none
};

/// Returns the name of a port as fleets say it: without the module.
std::string NameOf(const koord::Model& model, const sim::Port& port);
/// Returns what the fleet says of a port of this name; nullptr if it says nothing.
const sim::FleetPort* Said(const sim::Fleet& fleet, const std::string& name);
/// Returns what the values of a port are to an adapter: kNumber, kBool, kPoint; nothing if it cannot have them.
std::optional<Carries> AdaptedAs(const koord::Model& model, const sim::Port& port);

/// Returns the topic of a port of a robot: what the fleet says, else the usual one. Nothing for `reached`, unless the fleet
/// names a topic: the robot finds out by itself whether it is where it was told to go.
std::optional<Topic> TopicOf(const koord::Model& model, const sim::Fleet& fleet, size_t robot,
                             const sim::Port& port);
/// Returns the usual topic on which a robot says where it is, whether a port asks for it or not.
Topic OdometryOf(const sim::Fleet& fleet, size_t robot);
/// Returns the topic on which its autopilot hears where to fly, whether a port says it or not, if the fleet has autopilots.
Topic SetpointsOf(const sim::Fleet& fleet, size_t robot);

/// Name the topics that an autopilot has beside those of its odometry, and of its setpoints.
inline constexpr const char *kControlMode = "vehicle_control_mode", *kOffboardMode = "offboard_control_mode",
                            *kVehicleCommand = "vehicle_command";
/// Returns a topic of this name that lies beside another.
std::string Beside(const std::string& topic, const char* name);
/// Returns the other topics that go with one: those of an autopilot.
std::vector<std::string> TopicsBeside(const Topic& topic);

/// Returns the type of the messages on it.
const ros::Message& TypeOf(Carries carries);

/// Returns a header with this frame and this time, in nanoseconds since 1970.
ros::std_msgs::Header HeaderOf(const std::string& frame, int64_t stamp);
/// Converts times since 1970 in nanoseconds.
ros::builtin_interfaces::Time StampOf(int64_t nanoseconds);
int64_t WallTime();

/// Converts a point; `Finite`: none of its numbers is infinite or none.
inline sim::Point PointOf(const ros::geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }
inline ros::geometry_msgs::Point PointOf(const sim::Point& p) { return {p[0], p[1], p[2]}; }
inline bool Finite(const sim::Point& p) { return std::isfinite(p[0] + p[1] + p[2]); }

/// Converts angles around the vertical axis, in radians, and orientations; of one that is none, the angle is 0.
ros::geometry_msgs::Quaternion Turned(double yaw);
double YawOf(const ros::geometry_msgs::Quaternion& q);

}  // namespace rondo::platform
