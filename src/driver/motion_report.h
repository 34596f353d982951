#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>

#include "choreo/infer/regions.h"
#include "choreo/prove/report.h"
#include "diag/source.h"

namespace rondo::driver {

/// A choreography and what was found about it.
struct MotionReport {
  const choreo::Graph* graph = nullptr;
  choreo::Inference regions;
  choreo::Obligations obligations;
  choreo::Proofs proofs;
  std::set<std::string> discharged;  ///< motions whose contracts are proved (`rondo reach`)
  bool interrupted = false;
};

/// 0, 1, 3 or 4: whether everything that has to hold was proved.
int StatusOf(const MotionReport& report);

/// One line for each kind of obligation: how many hold, fail, are open, and how long that took.
std::string MotionTable(const MotionReport& report);

/// Looks for the regions that are missing, for so many seconds for each fork, with progress on a terminal;
/// Ctrl-C stops it.
choreo::Inference FindRegions(choreo::Graph& graph, expr::Arena& arena, double seconds,
                              const base::StopToken& stop);

/// Reports the threads for which no region was found, and why.
void ReportRegions(const choreo::Inference& regions, diag::Diagnostics& diagnostics);

/// The verdict and what it rests on.
std::string MotionSummary(const MotionReport& report, const diag::SourceSet& sources);

/// `FILE:LINE: thread region REGION  # of `cart`` for each region that was found.
std::string RegionLines(const choreo::Inference& regions, const diag::SourceSet& sources);

nlohmann::json ToJson(const MotionReport& report);

}  // namespace rondo::driver
