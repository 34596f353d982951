#include "platform/adapters.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace rondo::platform {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(1500);

// Calls what the user wrote; returns what it threw, for people.
template <class Call>
std::string Thrown(const Call& call) {
  try {
    call();
    return {};
  } catch (const std::exception& e) {
    return e.what()[0] == '\0' ? "it failed" : e.what();
  } catch (...) {
    return "it failed, and did not say why";
  }
}

// Asks the thread of what is shared to end, and waits for it, but not for ever.
template <class Shared>
void End(Shared& shared) {
  std::unique_lock lock(shared.mutex);
  shared.ending = true;
  shared.changed.notify_all();
  shared.changed.wait_for(lock, kPatience, [&] { return shared.ended; });
}

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
  std::unique_ptr<T> made;
  const std::string thrown = Thrown([&] { made.reset(make(site)); });
  if (made == nullptr) return base::Error{fmt::format("the adapter of `{}`: {}", site.port, thrown)};
  return made;
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

// What a thread uses that may outlive who started it.
struct AdaptedSensor::Shared {
  std::unique_ptr<adapter::Sensor> sensor;
  size_t parts;
  const Clock& clock;
  std::mutex mutex;
  std::condition_variable changed;
  Said said;
  bool ending = false, ended = false;

  void Take(const adapter::Sample& sample) {
    const std::lock_guard lock(mutex);
    if (ending) return;  // the clock may be gone
    said.wrong = Wrong(sample);
    if (!said.wrong.empty()) return;
    std::ranges::copy(sample.numbers, said.numbers.begin());
    said.at = clock.Now() - static_cast<Time>(sample.age * 1e9);
  }

  std::string Wrong(const adapter::Sample& sample) const {
    if (!sample.problem.empty()) return sample.problem;
    if (sample.numbers.size() != parts)
      return fmt::format("it says {} numbers, and has to say {}", sample.numbers.size(), parts);
    if (!std::isfinite(sample.age) || sample.age < 0 || sample.age > 1e9)
      return "it says an age that is none";
    const bool finite = std::ranges::all_of(sample.numbers, [](double x) { return std::isfinite(x); });
    return finite ? "" : "it says a number that is not finite";
  }

  void Run() {
    std::unique_lock lock(mutex);
    while (!ending) {
      lock.unlock();
      adapter::Sample sample;
      const std::string thrown = Thrown([&] { sample = sensor->Read(); });
      if (!thrown.empty()) sample = {{}, 0, thrown};
      Take(sample);
      lock.lock();
      // Whoever does not wait for the next value is asked a hundred times a second.
      changed.wait_for(lock, std::chrono::milliseconds(10), [&] { return ending; });
    }
    ended = true;
    changed.notify_all();
  }
};

AdaptedSensor::AdaptedSensor(std::unique_ptr<adapter::Sensor> sensor, size_t parts, const Clock& clock)
    : shared_(new Shared{std::move(sensor), parts, clock, {}, {}, {}, false, false}) {
  std::thread([shared = shared_] { shared->Run(); }).detach();
}

AdaptedSensor::~AdaptedSensor() { End(*shared_); }

AdaptedSensor::Said AdaptedSensor::said() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->said;
}

struct AdaptedActuator::Shared {
  std::unique_ptr<adapter::Actuator> actuator;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<std::vector<double>> numbers;
  std::string problem;
  std::optional<std::chrono::steady_clock::time_point> since;  // it is being written
  bool ending = false, ended = false;

  void Run() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return ending || numbers; });
      if (!numbers) break;
      const std::vector<double> now = *std::exchange(numbers, std::nullopt);
      since = std::chrono::steady_clock::now();
      lock.unlock();
      const std::string thrown = Thrown([&] { actuator->Write(now); });
      lock.lock();
      since.reset();
      if (!thrown.empty()) problem = thrown;
      if (ending) break;
    }
    lock.unlock();
    actuator->Safe();
    lock.lock();
    ended = true;
    changed.notify_all();
  }
};

AdaptedActuator::AdaptedActuator(std::unique_ptr<adapter::Actuator> actuator)
    : shared_(new Shared{std::move(actuator), {}, {}, {}, {}, {}, false, false}) {
  std::thread([shared = shared_] { shared->Run(); }).detach();
}

AdaptedActuator::~AdaptedActuator() { End(*shared_); }

void AdaptedActuator::Write(std::vector<double> numbers) {
  const std::lock_guard lock(shared_->mutex);
  shared_->numbers = std::move(numbers);
  shared_->changed.notify_all();
}

std::string AdaptedActuator::TakeProblem() {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->since && std::chrono::steady_clock::now() - *shared_->since > kPatience) {
    shared_->since = std::chrono::steady_clock::now();  // said again when it hangs for as long again
    return "it does not come back from what it was told";
  }
  return std::exchange(shared_->problem, {});
}

}  // namespace rondo::platform
