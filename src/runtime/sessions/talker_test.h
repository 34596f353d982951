#pragma once

#include <deque>
#include <map>
#include <vector>

#include "runtime/sessions/member.h"

namespace rondo::runtime::sessions {

/// Sends what it is told, and takes whatever comes, for ever.
struct Talker : Program, Motions {
  struct Message {
    uint32_t to;
    double number;
  };
  std::deque<Message> to_send;
  std::map<uint32_t, std::vector<double>> taken;
  uint32_t robots = 0, self = 0;
  Step step;

  Step Next() override {
    step = Step();
    if (!to_send.empty()) {
      step.kind = Step::Kind::kSend;
      step.to = to_send.front().to;
      step.label = "m";
      step.values = {to_send.front().number};
      return step;
    }
    step.kind = Step::Kind::kReceive;
    step.ends = true;
    for (uint32_t r = 0; r < robots; ++r) {
      if (r != self) step.cases.push_back({r, "m"});
    }
    return step;
  }
  bool Waits() const override { return false; }
  void Sent() override { to_send.pop_front(); }
  // What it takes it hands on, as long as it is worth something: nobody knows beforehand who is at its end.
  void Took(size_t which, const std::vector<double>& values) override {
    taken[step.cases[which].from].push_back(values[0]);
    const auto rest = static_cast<int>(values[0]) / 10 % 10;
    if (rest > 0) to_send.push_back({(self + 1) % robots, values[0] - 10});
  }
  void Moved() override {}
  void Begin(size_t) override {}
  Progress Tick() override { return Progress::kStopped; }
  void Halt() override {}
};

}  // namespace rondo::runtime::sessions
