#include "driver/motion_prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "choreo/draw/scene.h"
#include "choreo/prove/sampler.h"
#include "driver/discharge.h"
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
    // First of all, as `rondo reach` does: sums are written in the order in which their terms are made.
    if (motion->declarations != nullptr && !session_.diagnostics.has_errors() && options_.cache) {
      const solve::cache::ProofCache cache(solve::cache::ProofCache::DefaultFolder());
      discharged_ = ProvedMotions(*motion, cache);
    }
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
      Prove(graph, own, *motion);
    }
    int status = kEstablished;
    for (const MotionReport& r : reports_) status = Worse(status, StatusOf(r));
    return Finish(status);
  }

 private:
  void Prove(choreo::Graph& graph, const std::vector<choreo::SideCondition>& conditions, Motion& motion) {
    expr::Arena& arena = motion.arena;
    MotionReport report;
    report.graph = &graph;
    report.regions = FindRegions(graph, arena, options_.timeout, stop_);
    report.discharged = discharged_[&graph];
    report.obligations = choreo::ObligationsOf(graph, arena, conditions, report.discharged);
    // Said below, with the reason.
    if (!report.regions.failed.empty())
      std::erase_if(report.obligations.missing, [](const choreo::Missing& m) { return m.region; });
    const solve::cache::ProofCache cache(options_.cache ? solve::cache::ProofCache::DefaultFolder()
                                                        : std::filesystem::path());
    choreo::ProveOptions prove;
    prove.limits.time = std::chrono::milliseconds(static_cast<int64_t>(options_.timeout * 1000));
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
    choreo::ConfirmWitnesses(report.obligations, arena, report.proofs);
    choreo::ReportProofs(graph, report.obligations, report.proofs, session_.diagnostics);
    ReportRegions(report.regions, session_.diagnostics);
    reports_.push_back(std::move(report));
    if (!options_.svg.empty() && reports_.size() == 1) picture_ = Picture(reports_.back(), arena);
  }

  // The scene of the first shapes that fail to keep apart, or else as it begins.
  static std::string Picture(const MotionReport& report, expr::Arena& arena) {
    const choreo::Graph& graph = *report.graph;
    const choreo::Obligation* failed = nullptr;
    expr::Numeric::Point state;
    std::string title = fmt::format("{}, as it begins", graph.source->name.text);
    for (size_t i = 0; i < report.obligations.all.size() && failed == nullptr; ++i) {
      const auto& [o, d] = std::tie(report.obligations.all[i], report.proofs.all[i].decision);
      if (!o.meeting || d.verdict == choreo::Verdict::kProved || d.witness.values.empty()) continue;
      failed = &o;
      state = d.witness.values;
      title = o.failure;
    }
    if (failed == nullptr) {
      std::mt19937_64 random(1);
      if (auto begins = choreo::Sampler(arena, graph.initially).Draw(random, 1000))
        state = std::move(*begins);
    }
    std::optional<std::array<double, 3>> mark;
    std::array<double, 3> at{};
    size_t known = 0;
    for (size_t i = 0; i < 3; ++i) {
      const auto it = state.find(graph.world->point[i]);
      if (it != state.end()) at[i] = it->second, ++known;
    }
    if (known == 3) mark = at;
    std::vector<choreo::Drawn> shapes;
    for (const robot::Obstacle& o : graph.world->obstacles)
      shapes.push_back({o.name.text, o.shape, "#666666", "#333333"});
    for (const robot::Body& b : graph.world->bodies) {
      const bool placed =
          std::ranges::all_of(b.states, [&](const auto& v) { return state.contains(v.term); });
      if (b.body && placed) shapes.push_back({b.name.text, *b.body, "#bbbbbb", "#777777"});
    }
    if (failed != nullptr) {
      constexpr std::array<std::string_view, 2> kFills{"#4080ff", "#ff9020"}, kStrokes{"#1040a0", "#a05000"};
      for (size_t i = 0; i < failed->meeting->shapes.size() && i < 2; ++i)
        shapes.push_back({"", failed->meeting->shapes[i], kFills[i], kStrokes[i]});
    }
    return choreo::DrawScene(arena, shapes, state, mark, title);
  }

  int Finish(int status) {
    if (!picture_.empty() && WritePicture(options_.svg, picture_, options_.json) != kEstablished)
      status = Worse(status, kRejected);
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
  std::map<const choreo::Graph*, std::set<std::string>> discharged_;
  std::string picture_;
};

}  // namespace

int ProveMotion(const MotionProveOptions& options) { return Run(options)(); }

}  // namespace rondo::driver
