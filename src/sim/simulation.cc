#include "sim/simulation.h"

#include <algorithm>
#include <cmath>

#include "sim/run.h"

namespace rondo::sim {

using diag::Kind;

SimulationReport Run::Go() {
  ports_ = FindPorts(model_, fleet_.robots, diagnostics_);
  const bool maps =
      std::any_of(model_.variables.begin(), model_.variables.end(), [&](const koord::Variable& v) {
        return v.kind == koord::VariableKind::kAllwrite && model_.types.Is(v.type, lang::TypeKind::kOpaque);
      });
  if (fleet_.until == Until::kMapped && !maps)
    diagnostics_.Report(Kind::kFleetValue, fleet_.until_span, "the program draws no shared map");
  if (!MakeTeam() || diagnostics_.has_errors() || !MakeRobots() || !Start()) return std::move(report_);
  report_.ran = true;
  const double end = options_.duration > 0 ? options_.duration : fleet_.duration;
  FindPeriods();
  report_.ended = Ending::kTime;
  if (options_.network != nullptr) {
    OverNetwork(end);
    Finish();
    return std::move(report_);
  }
  const auto rounds = static_cast<uint64_t>(std::ceil(end / fleet_.delta - 1e-9));
  for (uint64_t k = 0; k < rounds && report_.ended == Ending::kTime; ++k) {
    if (options_.stop.StopRequested()) {
      report_.ended = Ending::kInterrupted;
      break;
    }
    Round(k);
    if (options_.progress) options_.progress(report_.time, end);
  }
  Finish();
  return std::move(report_);
}

std::string_view Name(Ending ending) {
  switch (ending) {
    case Ending::kTime:
      return "time";
    case Ending::kQuiet:
      return "quiet";
    case Ending::kStopped:
      return "stopped";
    case Ending::kMapped:
      return "mapped";
    case Ending::kInterrupted:
      return "interrupted";
    case Ending::kFailed:
      return "failed";
  }
  return "";
}

SimulationReport Simulate(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options,
                          trace::Writer* trace, diag::Diagnostics& diagnostics) {
  return Run(model, fleet, options, trace, diagnostics).Go();
}

}  // namespace rondo::sim
