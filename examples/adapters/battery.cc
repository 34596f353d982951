// The charge of a battery, in per cent, from a file in which the kernel says it.
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "rondo/adapter.h"

namespace {

using namespace rondo::adapter;

class Battery : public Sensor {
 public:
  explicit Battery(const Site& site) : file_(site.options) {
    if (file_.empty()) throw std::runtime_error("say in which file: `with = \"...\"`");
  }

  Sample Read() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ifstream file(file_);
    double percent = 0;
    if (!(file >> percent)) return {.problem = "cannot read " + file_};
    return {.numbers = {percent}};
  }

 private:
  const std::string file_;
};

}  // namespace

RONDO_SENSOR(Battery)
