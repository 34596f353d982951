#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "dds/participant.h"
#include "platform/motions/body_topics.h"

namespace rondo::platform {

/// Stands for the drivers of the robots of a world: bodies in a scene that are reached over topics of ROS 2 alone. Each robot has a
/// node of its own, `/ROBOT/driver`; all are one participant. Not thread-safe, but for what arrives.
class BodyDrivers {
 public:
  /// Both outlive it.
  BodyDrivers(const robot::World& world, const expr::Arena& arena, sim::motions::SceneState& scene);

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant);

  /// Lets so many seconds pass: bases move as they were told, and stand still if they were told nothing for half a second;
  /// joints move evenly to each point of their trajectory, and stay at the last.
  void Step(double dt);
  /// Says where all bodies are, and what the signals are.
  void Tell();

 private:
  struct Driven {
    double forward = 0, left = 0, turn = 0;
    double age = 1e9;  // seconds since it was told
  };
  // Where a joint is to be, some seconds from now.
  struct Point {
    double within = 0;
    double position = 0;
  };
  struct One {
    BodyTopics topics;
    Driven driven;
    std::vector<std::vector<Point>> ways;  // by joint
    std::unique_ptr<dds::Publisher> odometry, joints;
  };
  struct Voice {
    size_t place;
    std::unique_ptr<dds::Publisher> publisher;
  };
  base::Result<bool> Begin(dds::Participant& participant, size_t robot);
  base::Result<bool> Speak(dds::Participant& participant, size_t node, const std::vector<Signal>& signals);
  void Hear(One& one, std::string_view trajectory);

  sim::motions::SceneState& scene_;
  const std::vector<Signal> environment_;
  std::vector<One> ones_;
  std::vector<Voice> voices_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
