#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "sim/fleet/fleet.h"

namespace rondo::platform {

/// Behaves as PX4 does on its topics: flies to setpoints if it is armed, was asked to listen, and hears a heartbeat; says where
/// it is, and who steers. To be used for a simulated body.
class SimulatedAutopilot {
 public:
  /// @param body, origin  outlive it. `system`: it obeys commands to that number.
  SimulatedAutopilot(sim::Body& body, const sim::Origin& origin, uint8_t system)
      : body_(body), origin_(origin), system_(system) {}

  /// Begins. @param odometry, setpoints  its topics: the others lie beside them. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node, const std::string& odometry,
                           const std::string& setpoints);

  /// Lets `dt` seconds pass: does what it was told.
  void Step(double dt);
  /// Says where it is. @param stamp  nanoseconds since 1970.
  void Tell(int64_t stamp);

 private:
  static constexpr double kLongAgo = 1e9;
  void Obey(uint32_t command, float first, float second);

  sim::Body& body_;
  const sim::Origin& origin_;
  const uint8_t system_;
  bool armed_ = false, offboard_ = false;
  double spoken_for_ = 0;         // seconds in which heartbeats came
  double silent_for_ = kLongAgo;  // since the last
  std::unique_ptr<dds::Publisher> odometry_, modes_;
  std::mutex mutex_;
  bool heartbeat_ = false;  // came since the last step
  std::optional<sim::Point> setpoint_;
  struct Command {
    uint32_t command;
    float first, second;
  };
  std::vector<Command> commands_;
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
