#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "platform/messages.h"
#include "platform/simulated_autopilot.h"

/// Stands for the drivers of robots: simulated bodies that are reached over topics of ROS 2 alone.
namespace rondo::platform {

/// Lets the bodies of a fleet read orders from topics, and say there what their sensors read. Each robot has a node of its own,
/// `/NAMESPACE/driver`; all are one participant.
class Drivers {
 public:
  /// @param ports  of the program; outlives this, as do the others.
  Drivers(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
          const std::vector<std::unique_ptr<sim::Body>>& bodies, bool simulated_time);

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant);

  /// Lets bodies do what came since the last call.
  void Obey();
  /// Lets a period of `dt` seconds pass for all bodies: those that are told how to move do that, and stand still when they were
  /// told nothing for half a second; others have controllers. Returns the first whose state is not finite any more.
  std::optional<size_t> Step(double dt);
  /// Says what time it is, `t` seconds from the start: on `/clock`, if time is simulated. What is said until it is called again has
  /// this time.
  void TellTime(double t);
  /// Says where the bodies are, and what else their sensors read. `scans`: by robot; empty: no scanner has turned.
  void Tell(const std::vector<sim::Rays>& scans);

 private:
  struct Order {
    size_t robot;
    const sim::Port* port;
    std::vector<sim::Point> path;
    Numbers numbers{};
    std::optional<sim::Twist> twist;
  };
  struct Driven {
    sim::Twist twist;
    double age = 1e9;  // seconds since it was told
  };
  struct Voice {
    size_t robot;
    const sim::Port* port;  // nullptr: odometry that no port asks for
    Topic topic;
    std::unique_ptr<dds::Publisher> publisher;
  };
  // A goal of Nav2 (action_msgs/GoalStatus).
  struct Goal {
    uint64_t number = 0;
    int64_t accepted = 0;
    int8_t status = 0;
  };
  base::Result<bool> Begin(dds::Participant& participant, size_t robot);
  base::Result<bool> Listen(dds::Participant& participant, size_t node, size_t robot, const sim::Port& port);
  base::Result<bool> Speak(dds::Participant& participant, size_t node, size_t robot, const sim::Port* port,
                           const Topic& topic);
  void Hear(size_t robot, const sim::Port& port, const Topic& topic, std::string_view bytes);
  void Pose(const Voice& voice);
  void Scan(const Voice& voice, const sim::Rays& rays);
  void Status(const Voice& voice);
  void Other(const Voice& voice);
  ros::std_msgs::Header Header(const std::string& frame) const { return HeaderOf(frame, stamp_); }

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const std::vector<sim::Port>& ports_;
  const std::vector<std::unique_ptr<sim::Body>>& bodies_;
  const bool simulated_time_;
  int64_t stamp_ = 0;  // of what is said now
  std::vector<Voice> voices_;
  std::vector<std::unique_ptr<SimulatedAutopilot>> autopilots_;  // by robot; nullptr: it has none
  std::vector<Goal> goals_;                                      // by robot
  std::unique_ptr<dds::Publisher> transforms_, clock_;
  std::vector<std::optional<Driven>> driven_;  // by robot
  std::mutex mutex_;
  std::vector<Order> orders_;
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
