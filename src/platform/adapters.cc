#include "platform/adapters.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace rondo::platform {
namespace {

// Makes what a library has under this name.
template <class T>
base::Result<std::unique_ptr<T>> Make(const std::string& library, const char* maker, const char* macro,
                                      const adapter::Site& site) {
  void* handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr)
    return base::Error{fmt::format("cannot load the adapter of `{}`: {}", site.port, ::dlerror())};
  const auto version = reinterpret_cast<int (*)()>(::dlsym(handle, "rondo_adapter_version"));
  const auto make = reinterpret_cast<T* (*)(const adapter::Site&)>(::dlsym(handle, maker));
  if (version == nullptr || make == nullptr)
    return base::Error{
        fmt::format("`{}` is no adapter for `{}`: it has no `{}(Class)`", library, site.port, macro)};
  if (version() != adapter::kVersion)
    return base::Error{
        fmt::format("`{}` was made for version {} of adapters, and this is version {}: compile it again",
                    library, version(), adapter::kVersion)};
  try {
    return std::unique_ptr<T>(make(site));
  } catch (const std::exception& e) {
    return base::Error{fmt::format("the adapter of `{}`: {}", site.port, e.what())};
  }
}

}  // namespace

base::Result<std::unique_ptr<adapter::Sensor>> MakeSensor(const std::string& library,
                                                          const adapter::Site& site) {
  return Make<adapter::Sensor>(library, "rondo_make_sensor", "RONDO_SENSOR", site);
}

base::Result<std::unique_ptr<adapter::Actuator>> MakeActuator(const std::string& library,
                                                              const adapter::Site& site) {
  return Make<adapter::Actuator>(library, "rondo_make_actuator", "RONDO_ACTUATOR", site);
}

AdaptedSensor::AdaptedSensor(std::unique_ptr<adapter::Sensor> sensor, size_t parts, const Clock& clock)
    : sensor_(std::move(sensor)), parts_(parts), clock_(clock), thread_([this] { Run(); }) {}

AdaptedSensor::~AdaptedSensor() {
  ended_ = true;
  thread_.join();
}

AdaptedSensor::Said AdaptedSensor::said() const {
  const std::lock_guard lock(mutex_);
  return said_;
}

void AdaptedSensor::Run() {
  while (!ended_) {
    try {
      Take(sensor_->Read());
    } catch (const std::exception& e) {
      Take({{}, 0, e.what()[0] == '\0' ? "it failed" : e.what()});
    }
    // Whoever does not wait for the next value is asked a hundred times a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void AdaptedSensor::Take(const adapter::Sample& sample) {
  const std::lock_guard lock(mutex_);
  said_.wrong = sample.problem;
  if (!said_.wrong.empty()) return;
  if (sample.numbers.size() != parts_) {
    said_.wrong = fmt::format("it says {} numbers, and has to say {}", sample.numbers.size(), parts_);
    return;
  }
  if (!std::isfinite(sample.age) || sample.age < 0 || sample.age > 1e9) {
    said_.wrong = "it says an age that is none";
    return;
  }
  for (size_t i = 0; i < parts_; ++i) {
    if (!std::isfinite(sample.numbers[i])) said_.wrong = "it says a number that is not finite";
    said_.numbers[i] = sample.numbers[i];
  }
  said_.at = clock_.Now() - static_cast<Time>(sample.age * 1e9);
}

}  // namespace rondo::platform
