#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "base/result.h"
#include "base/stop.h"
#include "choreo/node/cast.h"
#include "deploy/choreography/session_event.h"
#include "platform/motions/body_drivers.h"
#include "sim/motions/contacts.h"
#include "sim/motions/disturbances.h"
#include "sim/motions/stage_recorder.h"

namespace rondo::deploy {

/// Lets the bodies of a choreography move by the clock, on a thread of its own; robots reach them over ROS 2 alone. Watches
/// whether bodies touch, hears what the robots say that they do, and records both.
class ChoreographyStage {
 public:
  /// Everything outlives it. @param recorder  nullptr: nothing is recorded.
  ChoreographyStage(const choreo::Cast& cast, uint64_t seed, sim::motions::StageRecorder* recorder);
  ChoreographyStage(const ChoreographyStage&) = delete;
  ChoreographyStage& operator=(const ChoreographyStage&) = delete;
  ~ChoreographyStage() { End(); }

  /// Puts everything where the choreography may begin, and begins.
  /// @error if there is no such place, or in the words of the library of the network.
  base::Result<bool> Begin(dds::Participant& participant);
  /// Returns how many seconds have passed.
  double time() const { return time_; }
  /// Returns what the robots said since the last call.
  std::vector<SessionEvent> TakeEvents();
  /// Ends, and returns what was seen: contacts, and how near everything was.
  const sim::motions::ChoreographyReport& End();
  /// Returns by how many seconds the bodies were behind the clock, at most. To be asked for when it has ended.
  double behind() const { return behind_; }

 private:
  base::Result<bool> Listen(dds::Participant& participant);
  void Hear(size_t robot, std::string_view bytes);
  void Run();
  void Record(const SessionEvent& event, size_t robot);

  const choreo::Cast& cast_;
  sim::motions::StageRecorder* recorder_;
  std::mt19937_64 random_;
  sim::motions::SceneState scene_;
  sim::motions::ChoreographyReport report_;
  platform::BodyDrivers drivers_;
  std::optional<sim::motions::Disturbances> disturbances_;
  std::optional<sim::motions::Contacts> contacts_;
  std::atomic<double> time_ = 0;
  double behind_ = 0;
  base::StopToken stop_;
  std::mutex mutex_;
  std::vector<std::pair<size_t, SessionEvent>> heard_;  // by whom, for the trace
  std::vector<SessionEvent> events_;                    // for whoever asks
  std::vector<std::unique_ptr<dds::Subscription>> subscriptions_;
  std::thread thread_;
};

}  // namespace rondo::deploy
