#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "reach/simulation/rondo_simulator.h"
#include "reach/simulation/simulator.h"

namespace rondo::reach {

namespace {

using Simulate = decltype(&rondo_simulate);

class Library final : public Simulator {
 public:
  Library(std::shared_ptr<void> handle, Simulate simulate, size_t dimension)
      : handle_(std::move(handle)), simulate_(simulate), dimension_(dimension) {}

  size_t dimension() const override { return dimension_; }

  base::Result<Trace> Run(std::span<const double> start, double dt, size_t steps) override {
    // One thread at a time, whatever simulator it is of: libraries have global variables.
    static std::mutex mutex;
    Trace trace((steps + 1) * dimension_, std::nan(""));
    int status = 0;
    {
      const std::lock_guard lock(mutex);
      status = simulate_(start.data(), dimension_, dt, steps, trace.data());
    }
    if (status != 0) return base::Error{fmt::format("the simulator failed with {}", status)};
    for (const double x : trace) {
      if (!std::isfinite(x)) return base::Error{"a run of the simulator is not finite, or not complete"};
    }
    return trace;
  }

 private:
  std::shared_ptr<void> handle_;
  Simulate simulate_;
  size_t dimension_;
};

}  // namespace

base::Result<std::unique_ptr<Simulator>> LibrarySimulator(const std::string& path, size_t dimension) {
  // Without a slash it would be looked for elsewhere.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* const opened = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (opened == nullptr) return base::Error{fmt::format("cannot load `{}`: {}", path, ::dlerror())};
  std::shared_ptr<void> handle(opened, [](void* h) { ::dlclose(h); });
  void* const symbol = ::dlsym(opened, "rondo_simulate");
  if (symbol == nullptr) return base::Error{fmt::format("`{}` has no function `rondo_simulate`", path)};
  return std::unique_ptr<Simulator>(
      std::make_unique<Library>(std::move(handle), reinterpret_cast<Simulate>(symbol), dimension));
}

}  // namespace rondo::reach
