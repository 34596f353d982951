#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "koord/node/node.h"
#include "platform/adapters.h"
#include "platform/clock.h"
#include "platform/goals.h"
#include "platform/offboard.h"
#include "platform/place.h"
#include "platform/topics.h"
#include "ros/sensor_msgs.h"
#include "runtime/rounds/settings.h"
#include "sim/bodies/waypoints.h"

namespace rondo::platform {

using koord::semantics::Heap;
using koord::semantics::Word;

/// Returns the topics that a robot listens to for its sensors, each once, and puts into `of_port`, by port, which of them it is on.
std::vector<Topic> SensedTopics(const koord::Model& model, const sim::Fleet& fleet,
                                const std::vector<sim::Port>& ports, size_t robot,
                                std::vector<std::optional<size_t>>& of_port);

/// Reads the sensors of one robot from topics of ROS 2, and from adapters of the user. Messages arrive on threads of the library; the robot's thread reads.
///
/// A sensor is usable if its last message is not older than its `max_age`, its numbers are finite, and what has a place can be
/// told in the frame of the fleet. Poses are transformed as `/tf` and `/tf_static` say.
class Senses final : public koord::node::Sensors {
 public:
  /// @param ports  of the program; outlives this, as do the others. `heap`: of the robot's team.
  Senses(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
         size_t robot, const sim::Body& body, Heap& heap, const Clock& clock);

  /// Begins to listen. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  /// Returns why the sensors are not usable now, for people: what to look at. Empty: they are.
  std::string Unusable();
  void Read(size_t robot, uint64_t round, koord::node::Cell cell, std::span<Word> words) override;
  bool Usable(size_t robot, uint64_t round) override;

  /// Says where the robot was told to go, without points to stay: `reached` of a program is about that, if no topic tells it.
  void GoesAlong(const std::vector<sim::Point>& path);
  /// Returns where it is, if anybody said so.
  std::optional<Place> place();
  /// Returns what its autopilot says of who steers, if there is one that did lately.
  std::optional<Autopilot> autopilot();

 private:
  // What a topic said last.
  struct Heard {
    Topic topic;
    std::optional<Time> at;
    std::string wrong;  // with what it said
    Numbers numbers{};  // of what is no odometry
    std::unique_ptr<AdaptedSensor> adapted;
    const dds::Subscription* subscription = nullptr;
  };
  struct Seen {
    Time at;
    sim::Point from;
    sim::Rays rays;
  };
  base::Result<dds::Subscription*> Listen(dds::Participant& participant, size_t node,
                                          const std::string& topic, const ros::Message& type,
                                          const ros::Qos& qos, dds::Receive receive);
  base::Result<bool> ListenToPilot(dds::Participant& participant, size_t node, const std::string& odometry);
  std::string WrongPilot(Time now) const;
  void FindPlace();
  bool NearGoal() const;
  void Hear(size_t heard, std::string_view bytes);
  void HearPlace(Heard& heard, const std::variant<Place, std::string>& place, Time now);
  void HearPilot(const Autopilot& pilot);
  void HearFrames(const ros::tf2_msgs::TFMessage& message);
  std::string Wrong(const Heard& heard, Time now) const;
  static double DistanceOf(float range, const ros::sensor_msgs::LaserScan& m);
  void HearScan(Heard& heard, const ros::sensor_msgs::LaserScan& m, Time now);

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const std::vector<sim::Port>& ports_;
  const size_t robot_;
  Heap& heap_;
  const Clock& clock_;
  const sim::Waypoints::Tolerance tolerance_;

  std::mutex mutex_;
  std::vector<Heard> heard_;
  std::vector<std::optional<size_t>> of_port_;  // by port: which of these
  std::optional<Place> place_;
  Time place_at_ = 0;
  std::vector<Seen> seen_;  // since they were read last, of a round at most
  Frames frames_;
  sim::Waypoints way_;
  Goals goals_;
  bool pilots_ = false;  // there is an autopilot
  std::optional<Autopilot> pilot_;
  bool flew_ = false;                    // it was armed, once
  std::optional<size_t> adapted_place_;  // which of these says where it is, if a library does
  bool began_ = false;                   // the first round
  std::vector<Word> words_;              // kept for its memory
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
