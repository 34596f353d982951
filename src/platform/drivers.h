#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "platform/topics.h"

/// Stands for the drivers of robots: simulated bodies that are reached over topics of ROS 2 alone.
namespace rondo::platform {

/// Lets the bodies of a fleet read orders from topics, and say there what their sensors read. Each robot has a node of its own,
/// `/NAMESPACE/driver`; all are one participant.
class Drivers {
 public:
  /// @param ports  of the program; outlives this, as do the others.
  Drivers(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
          const std::vector<std::unique_ptr<sim::Body>>& bodies);

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant);

  /// Lets bodies do what came since the last call.
  void Obey();
  /// Lets a period of `dt` seconds pass for all bodies: those that are told how to move do that, and stand still when they were
  /// told nothing for half a second; others have controllers. Returns the first whose state is not finite any more.
  std::optional<size_t> Step(double dt);
  /// Says where the bodies are, and what else their sensors read. `scans`: by robot; empty: no scanner has turned.
  void Tell(const std::vector<sim::Rays>& scans);

 private:
  struct Order {
    size_t robot;
    const sim::Port* port;
    std::vector<sim::Point> path;
    std::array<double, 3> numbers{};
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
  base::Result<bool> Listen(dds::Participant& participant, size_t node, size_t robot, const sim::Port& port);
  void Hear(size_t robot, const sim::Port& port, Carries carries, std::string_view bytes);
  void Odometry(const Voice& voice);
  void Scan(const Voice& voice, const sim::Rays& rays);
  void Other(const Voice& voice);

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const std::vector<sim::Port>& ports_;
  const std::vector<std::unique_ptr<sim::Body>>& bodies_;
  std::vector<Voice> voices_;
  std::unique_ptr<dds::Publisher> transforms_;
  std::vector<std::optional<Driven>> driven_;  // by robot
  std::mutex mutex_;
  std::vector<Order> orders_;
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
