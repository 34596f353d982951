#pragma once

#include <atomic>
#include <memory>

#include "dds/participant.h"
#include "runtime/rounds/settings.h"

namespace rondo::platform {

using runtime::rounds::Time;

/// Is the time by which a robot runs: that of its machine, or what `/clock` says (`use_sim_time`). Thread-safe.
class Clock {
 public:
  explicit Clock(bool simulated) : simulated_(simulated) {}

  /// Begins to listen to `/clock`, if it is to be heard. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  bool simulated() const { return simulated_; }
  /// Reports whether it goes, or went: `/clock` was heard.
  bool begun() const { return !simulated_ || now_ > 0; }
  /// Returns nanoseconds that never step back and run through suspension: what `/clock` says is the same for all robots until it
  /// is set back, and goes on then from where it stood.
  Time Now() const;
  /// Returns how often it was set back.
  uint64_t set_back() const { return set_back_; }
  /// Returns what stands in the headers of messages: nanoseconds since 1970, or what `/clock` says.
  int64_t Stamp() const;

 private:
  void Hear(int64_t stamp);

  const bool simulated_;
  std::atomic<int64_t> stamp_ = 0;
  std::atomic<Time> now_ = 0;
  std::atomic<uint64_t> set_back_ = 0;
  Time shift_ = 0;                                   // of the thread that hears
  std::unique_ptr<dds::Subscription> subscription_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
