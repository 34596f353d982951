#pragma once

#include <nlohmann/json_fwd.hpp>

#include "choreo/prove/report.h"

namespace rondo::driver {

/// A choreography and what was found about it.
struct MotionReport {
  const choreo::Graph* graph = nullptr;
  choreo::Obligations obligations;
  choreo::Proofs proofs;
  bool interrupted = false;
};

/// 0, 1, 3 or 4: whether everything that has to hold was proved.
int StatusOf(const MotionReport& report);

/// One line for each kind of obligation: how many hold, fail, are open, and how long that took.
std::string MotionTable(const MotionReport& report);

/// The verdict and what it rests on.
std::string MotionSummary(const MotionReport& report);

nlohmann::json ToJson(const MotionReport& report);

}  // namespace rondo::driver
