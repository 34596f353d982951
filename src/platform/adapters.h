#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/result.h"
#include "platform/adapter.h"
#include "platform/clock.h"
#include "platform/messages.h"

namespace rondo::platform {

/// Loads the library of an adapter, which stays loaded, and makes it. @error says why that cannot be: the loader's words, another version, or
/// what its constructor threw.
base::Result<std::unique_ptr<adapter::Sensor>> MakeSensor(const std::string& library,
                                                          const adapter::Site& site);
base::Result<std::unique_ptr<adapter::Actuator>> MakeActuator(const std::string& library,
                                                              const adapter::Site& site);

/// Reads a sensor of the user on a thread of its own, and keeps what it said last.
class AdaptedSensor {
 public:
  /// @param parts  how many numbers it has to say. `clock` outlives it.
  AdaptedSensor(std::unique_ptr<adapter::Sensor> sensor, size_t parts, const Clock& clock);
  AdaptedSensor(const AdaptedSensor&) = delete;
  AdaptedSensor& operator=(const AdaptedSensor&) = delete;
  ~AdaptedSensor();

  /// Is what it said last: when that was so, and what is wrong with it.
  struct Said {
    std::optional<Time> at;
    Numbers numbers{};
    std::string wrong;
  };
  Said said() const;

 private:
  void Run();
  void Take(const adapter::Sample& sample);

  const std::unique_ptr<adapter::Sensor> sensor_;
  const size_t parts_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  Said said_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

}  // namespace rondo::platform
