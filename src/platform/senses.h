#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "koord/node/node.h"
#include "platform/frames.h"
#include "platform/topics.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "runtime/rounds/settings.h"
#include "sim/bodies/waypoints.h"

namespace rondo::platform {

using koord::semantics::Heap;
using koord::semantics::Word;
using runtime::rounds::Time;

/// Reads the sensors of one robot from topics of ROS 2. Messages arrive on threads of the library; the robot's thread reads.
///
/// A sensor is usable if its last message is not older than its `max_age`, its numbers are finite, and what has a place can be
/// told in the frame of the fleet. Poses are transformed as `/tf` and `/tf_static` say.
class Senses final : public koord::node::Sensors {
 public:
  /// @param ports  of the program; outlives this, as do the others. `heap`: of the robot's team.
  Senses(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
         size_t robot, const sim::Body& body, Heap& heap);

  /// Begins to listen. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  /// Returns why the sensors are not usable now, for people: what to look at. Empty: they are.
  std::string Unusable(Time now);
  void Read(size_t robot, uint64_t round, koord::node::Cell cell, std::span<Word> words) override;
  bool Usable(size_t robot, uint64_t round) override;

  /// Says where the robot was told to go, without points to stay: `reached` of a program is about that, if no topic tells it.
  void GoesAlong(const std::vector<sim::Point>& path);
  /// Returns where it is, if anybody said so.
  struct Place {
    sim::Point position{}, velocity{};
    double yaw = 0;
  };
  std::optional<Place> place();

 private:
  // What a topic said last.
  struct Heard {
    Topic topic;
    std::optional<Time> at;
    std::string wrong;                // with what it said
    std::array<double, 3> numbers{};  // of what is no odometry
  };
  struct Seen {
    Time at;
    sim::Point from;
    sim::Rays rays;
  };
  void Hear(size_t heard, std::string_view bytes);
  void HearOdometry(Heard& heard, const ros::nav_msgs::Odometry& m, Time now);
  static double DistanceOf(float range, const ros::sensor_msgs::LaserScan& m);
  void HearScan(Heard& heard, const ros::sensor_msgs::LaserScan& m, Time now);

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const std::vector<sim::Port>& ports_;
  const size_t robot_;
  Heap& heap_;
  const sim::Waypoints::Tolerance tolerance_;

  std::mutex mutex_;
  std::vector<Heard> heard_;
  std::vector<std::optional<size_t>> of_port_;  // by port: which of these
  std::optional<Place> place_;
  Time place_at_ = 0;
  std::vector<Seen> seen_;  // since they were read last, of a round at most
  Frames frames_;
  sim::Waypoints way_;
  std::vector<Word> words_;  // kept for its memory
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
