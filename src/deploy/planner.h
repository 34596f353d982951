#pragma once

#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <optional>
#include <thread>

#include "sim/functions/functions.h"

namespace rondo::deploy {

/// Plans paths on a thread of its own, while rounds go on. What is asked again within two seconds, while the robot is where it
/// was, is the same question, wherever other robots are meanwhile; its answer begins where the robot is now. Thread-safe.
class PlannerThread {
 public:
  /// @param near  how far a robot may be from where it asked, in metres; paths come as much nearer to obstacles.
  explicit PlannerThread(double near) : near_(near) {}
  PlannerThread(const PlannerThread&) = delete;
  PlannerThread& operator=(const PlannerThread&) = delete;
  ~PlannerThread();

  /// Returns the path, or that it is not there yet; then somebody works on it.
  /// @param wait  the answer has to be there now.
  sim::Functions::Planned Ask(const sim::World& world, const sim::PlanRequest& request, bool wait);

 private:
  struct Question {
    sim::World world;
    sim::PlanRequest request;
    std::chrono::steady_clock::time_point asked;
    std::optional<sim::Functions::Planned> answer;
  };
  Question* Find(const sim::World& world, const sim::PlanRequest& request);
  void Run();

  const double near_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Question> questions_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace rondo::deploy
