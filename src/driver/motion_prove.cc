#include "driver/motion_prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "choreo/infer/regions.h"
#include "driver/exit_status.h"
#include "driver/interrupt.h"
#include "driver/motion.h"
#include "driver/motion_report.h"
#include "driver/terminal.h"
#include "solve/cache/proof_cache.h"

namespace rondo::driver {
namespace {

// From best to worst: what went wrong anywhere is what the whole says.
int Worse(int a, int b) {
  constexpr std::array kOrder{kEstablished, kUndecided, kRejected, kBug};
  const auto rank = [&](int status) { return std::ranges::find(kOrder, status) - kOrder.begin(); };
  return rank(a) < rank(b) ? b : a;
}

class Run {
 public:
  explicit Run(const MotionProveOptions& options) : options_(options) {}

  int operator()() {
    const auto motion = LoadMotion(options_.files, options_.admitted, session_);
    if (motion == nullptr) return kRejected;
    const auto conditions = CheckStructure(*motion, session_);
    if (!conditions || session_.diagnostics.has_errors()) return Finish(kRejected);
    if (motion->graphs.empty()) {
      session_.diagnostics.Report(diag::Kind::kChoreoMissing, {}, "there is no choreography to prove");
      return Finish(kRejected);
    }
    for (choreo::Graph& graph : motion->graphs) {
      std::vector<choreo::SideCondition> own;
      for (const auto& c : *conditions) {
        if (c.graph == &graph) own.push_back(c);
      }
      Prove(graph, own, motion->arena);
    }
    int status = kEstablished;
    for (const MotionReport& r : reports_) status = Worse(status, StatusOf(r));
    return Finish(status);
  }

 private:
  void Prove(choreo::Graph& graph, const std::vector<choreo::SideCondition>& conditions,
             expr::Arena& arena) {
    MotionReport report;
    report.graph = &graph;
    {
      ProgressLine line;
      const InterruptScope interrupt(stop_);
      choreo::InferOptions infer;
      infer.stop = stop_;
      infer.limits.time = Milliseconds();
      infer.progress = [&](const std::string& robots) { line.Show("looking for regions of " + robots); };
      report.regions = choreo::InferRegions(graph, arena, infer);
    }
    report.obligations = choreo::ObligationsOf(graph, arena, conditions);
    // Said below, with the reason.
    if (!report.regions.failed.empty())
      std::erase_if(report.obligations.missing, [](const choreo::Missing& m) { return m.region; });
    const solve::cache::ProofCache cache(options_.cache ? solve::cache::ProofCache::DefaultFolder()
                                                        : std::filesystem::path());
    choreo::ProveOptions prove;
    prove.limits.time = Milliseconds();
    prove.limits.certificates = options_.certify;
    prove.jobs = options_.jobs;
    prove.cache = options_.cache ? &cache : nullptr;
    prove.smt_out = options_.smt_out;
    prove.certificates = options_.certificates;
    prove.stop = stop_;
    {
      ProgressLine line;
      const InterruptScope interrupt(stop_);
      prove.progress = [&](size_t done, size_t total, const std::string& what) {
        line.Show(fmt::format("[{}/{}] {}", done, total, what));
      };
      report.proofs = choreo::Prove(report.obligations, graph, arena, prove);
    }
    report.interrupted = stop_.cancelled();
    choreo::ReportProofs(graph, report.obligations, report.proofs, session_.diagnostics);
    for (const choreo::NoRegion& n : report.regions.failed) {
      session_.diagnostics.Report(diag::Kind::kChoreoNoRegion, n.span, "no region was found for this thread")
          .Note(n.why)
          .Help("write `thread region ... { ... }`, or let the motions keep farther apart");
    }
    reports_.push_back(std::move(report));
  }

  std::chrono::milliseconds Milliseconds() const {
    return std::chrono::milliseconds(static_cast<int64_t>(options_.timeout * 1000));
  }

  int Finish(int status) {
    if (options_.json) {
      nlohmann::json list = nlohmann::json::array();
      for (const MotionReport& r : reports_) list.push_back(ToJson(r));
      PrintJson({{"command", "prove"},
                 {"status", status},
                 {"choreographies", list},
                 {"diagnostics", DiagnosticsToJson(session_.sources, session_.diagnostics)}});
      return status;
    }
    for (const MotionReport& r : reports_) Print(MotionTable(r));
    if (!session_.diagnostics.all().empty()) {
      if (!reports_.empty()) Print("\n");
      PrintDiagnostics(session_.sources, session_.diagnostics);
    }
    if (!reports_.empty()) Print("\n");
    for (const MotionReport& r : reports_) Print(MotionSummary(r, session_.sources));
    if (status != kEstablished) Print(fmt::format("exit {}\n", status));
    return status;
  }

  const MotionProveOptions& options_;
  Session session_;
  base::StopToken stop_;
  std::vector<MotionReport> reports_;
};

}  // namespace

int ProveMotion(const MotionProveOptions& options) { return Run(options)(); }

}  // namespace rondo::driver
