#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapter/adapter.h"
#include "base/result.h"
#include "platform/clock.h"
#include "platform/messages.h"

namespace rondo::platform {

/// Loads the library of an adapter, which stays loaded, and makes it. @error says why that cannot be: the loader's words, another version, or
/// what its constructor threw.
base::Result<std::unique_ptr<adapter::Sensor>> MakeSensor(const std::string& library,
                                                          const adapter::Site& site);
base::Result<std::unique_ptr<adapter::Actuator>> MakeActuator(const std::string& library,
                                                              const adapter::Site& site);

/// Reads a sensor of the user on a thread of its own, and keeps what it said last. Who waits for the sensor for too long when this
/// ends is left behind, so that the robot can end.
class AdaptedSensor {
 public:
  /// @param parts  how many numbers it has to say. `clock` outlives it by as long as a thread may be left behind: for good.
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
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// Sets an actuator of the user on a thread of its own: the latest counts. Makes it safe when this ends.
class AdaptedActuator {
 public:
  explicit AdaptedActuator(std::unique_ptr<adapter::Actuator> actuator);
  AdaptedActuator(const AdaptedActuator&) = delete;
  AdaptedActuator& operator=(const AdaptedActuator&) = delete;
  ~AdaptedActuator();

  /// Waits for nothing.
  void Write(std::vector<double> numbers);
  /// Returns what it said when it could not do what it was told, since the last call, or that it hangs; empty: nothing.
  std::string TakeProblem();

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace rondo::platform
