// A lamp, by a file that switches it.
#include <fstream>
#include <stdexcept>

#include "rondo/adapter.h"

namespace {

using namespace rondo::adapter;

class Lamp : public Actuator {
 public:
  explicit Lamp(const Site& site) : file_(site.options) {}

  void Write(const std::vector<double>& numbers) override {
    if (!Switch(numbers[0] != 0)) throw std::runtime_error("cannot write " + file_);
  }

  void Safe() noexcept override { Switch(false); }

 private:
  bool Switch(bool on) {
    std::ofstream file(file_);
    return static_cast<bool>(file << (on ? "1" : "0") << std::flush);
  }

  const std::string file_;
};

}  // namespace

RONDO_ACTUATOR(Lamp)
