#pragma once

#include <memory>
#include <string>
#include <vector>

/// What a sensor or an actuator of one's own is to Rondo: a class in a shared library, which a fleet file names:
/// `[ports] charge = { adapter = "libbattery.so", with = "/dev/ttyUSB0" }`. This header needs nothing but the standard library.
namespace rondo::adapter {

/// Says for what an adapter is made.
struct Site {
  std::string robot;    ///< the name of the robot in the fleet
  std::string port;     ///< the port of the program, such as `charge`
  std::string options;  ///< what stands behind `with` in the fleet file
};

/// Is what a sensor read: one number for a `float`, 1 or 0 for a `bool`, three in metres for a `pos`.
struct Sample {
  std::vector<double> numbers = {};
  double age = 0;            ///< seconds since it was so
  std::string problem = {};  ///< for people; not empty: it cannot be relied on, and the robot skips
};

/// Reads one sensor of one robot.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Returns what it reads. A thread of its own calls this again and again: it may wait for the next value, for a second at most. If
  /// it throws, that is a problem of the sensor.
  virtual Sample Read() = 0;
};

/// Sets one actuator of one robot.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// Sets it to these numbers, as in `Sample`: each time that the program says something, and is allowed to. A thread of its own
  /// calls this: of what is said meanwhile, the latest counts.
  virtual void Write(const std::vector<double>& numbers) = 0;
  /// Makes it safe: the robot ends. Called once, behind the last `Write`.
  virtual void Safe() noexcept = 0;
};

/// Counts up when anything above changes.
inline constexpr int kVersion = 1;

}  // namespace rondo::adapter

/// Makes a class, whose constructor takes a `Site`, the sensor, or the actuator, of this library. A constructor that throws
/// says why there is none.
#define RONDO_SENSOR(Class)                                                                    \
  extern "C" int rondo_adapter_version() { return ::rondo::adapter::kVersion; }                \
  extern "C" ::rondo::adapter::Sensor* rondo_make_sensor(const ::rondo::adapter::Site& site) { \
    return std::make_unique<Class>(site).release();                                            \
  }
#define RONDO_ACTUATOR(Class)                                                                      \
  extern "C" int rondo_adapter_version() { return ::rondo::adapter::kVersion; }                    \
  extern "C" ::rondo::adapter::Actuator* rondo_make_actuator(const ::rondo::adapter::Site& site) { \
    return std::make_unique<Class>(site).release();                                                \
  }
