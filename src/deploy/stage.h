#pragma once

#include <atomic>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/stop.h"
#include "platform/drivers.h"
#include "sim/recorder.h"
#include "sim/touches.h"

namespace rondo::deploy {

/// Holds what was seen of the bodies of a fleet.
struct StageReport {
  double time = 0;  ///< seconds
  uint64_t collisions = 0;
  double first_collision = -1;
  std::string first_pair;
  double least_between_robots = 0,
         least_to_obstacles = 0;  ///< metres; infinite: nothing, or too many to measure
  double behind = 0;              ///< seconds by which the bodies were behind the clock, at most
  std::string failed;             ///< the state of a body is not finite; empty: all is well
};

/// Lets simulated bodies move by the clock, on a thread of its own; robots reach them over ROS 2 alone.
class Stage {
 public:
  /// @param speed  how many seconds pass in the world in one: not 1 only if time is simulated.
  /// @param trace  gets what happens, if there is one. All outlive this.
  Stage(const koord::Model& model, const sim::Fleet& fleet, uint64_t seed, double speed,
        trace::Writer* trace);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  ~Stage() { End(); }

  /// Finds the ports, and begins. Reports what is wrong with the program or the fleet.
  /// @param run  what the trace keeps of where the run came from.
  /// @error in the words of the library of the network. Empty: it was reported.
  base::Result<bool> Begin(dds::Participant& participant, const nlohmann::json& run,
                           diag::Diagnostics& diagnostics);
  /// Returns how many seconds have passed in the world.
  double time() const { return time_; }
  /// Ends, and returns what was seen.
  StageReport End();

 private:
  void Run();

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const uint64_t seed_;
  const double speed_;
  std::vector<sim::Port> ports_;
  std::vector<std::unique_ptr<sim::Body>> bodies_;
  std::vector<std::mt19937_64> noise_;
  sim::Recorder recorder_;
  std::unique_ptr<sim::Touches> touches_;
  std::unique_ptr<platform::Drivers> drivers_;
  bool scans_ = false;
  std::atomic<double> time_ = 0;
  base::StopToken stop_;
  StageReport report_;
  std::thread thread_;
};

}  // namespace rondo::deploy
