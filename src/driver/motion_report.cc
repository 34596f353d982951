#include "driver/motion_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/interrupt.h"
#include "driver/terminal.h"

namespace rondo::driver {

using choreo::ObligationKind;
using choreo::Proof;
using choreo::Verdict;

namespace {

std::string_view Words(ObligationKind kind) {
  switch (kind) {
    case ObligationKind::kHull:
      return "hulls contain bodies";
    case ObligationKind::kInitial:
      return "bodies apart initially";
    case ObligationKind::kPrecondition:
      return "preconditions of motions";
    case ObligationKind::kAssumption:
      return "assumptions of motions";
    case ObligationKind::kGuarantee:
      return "guarantees of threads";
    case ObligationKind::kBody:
      return "bodies within footprints";
    case ObligationKind::kCollision:
      return "robots apart";
    case ObligationKind::kObstacle:
      return "obstacles avoided";
    case ObligationKind::kRegion:
      return "motions within regions";
    case ObligationKind::kFork:
      return "regions apart";
    case ObligationKind::kThread:
      return "assumptions of threads";
    case ObligationKind::kTotalChoice:
      return "choices total";
    case ObligationKind::kMessage:
      return "messages as promised";
    case ObligationKind::kContract:
      return "contracts can be kept";
    case ObligationKind::kKeeping:
      return "motions can be kept";
    case ObligationKind::kInterrupted:
      return "motions may be interrupted";
    case ObligationKind::kProcess:
      return "processes do not deviate";
    case ObligationKind::kStart:
    case ObligationKind::kReached:
      break;
  }
  return "";
}

std::string_view Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved:
      return "proved";
    case Verdict::kRefuted:
      return "refuted";
    case Verdict::kUnknown:
      return "unknown";
  }
  return "";
}

std::string_view Name(choreo::Way way) {
  switch (way) {
    case choreo::Way::kSizes:
      return "sizes";
    case choreo::Way::kSeparation:
      return "separation";
    case choreo::Way::kPoints:
      return "points";
    case choreo::Way::kCurve:
      return "curve";
  }
  return "";
}

struct Counts {
  size_t holds = 0, fails = 0, open = 0;
  double seconds = 0;

  void Add(const Proof& proof) {
    (proof.decision.verdict == Verdict::kProved    ? holds
     : proof.decision.verdict == Verdict::kRefuted ? fails
                                                   : open) += 1;
    seconds += proof.seconds;
  }
};

template <typename Visit>
void ForRequired(const MotionReport& report, Visit visit) {
  for (size_t i = 0; i < report.obligations.all.size(); ++i) {
    if (choreo::IsRequired(report.obligations.all[i].kind))
      visit(report.obligations.all[i], report.proofs.all[i]);
  }
}

Counts Total(const MotionReport& report) {
  Counts total;
  ForRequired(report, [&](const auto&, const Proof& p) { total.Add(p); });
  return total;
}

}  // namespace

int StatusOf(const MotionReport& report) {
  const Counts total = Total(report);
  if (report.proofs.bug) return kBug;
  if (total.fails > 0 || !report.obligations.missing.empty()) return kRejected;
  if (total.open > 0 || !report.regions.failed.empty()) return kUndecided;
  return report.proofs.problems.empty() ? kEstablished : kRejected;
}

std::string MotionTable(const MotionReport& report) {
  std::map<ObligationKind, Counts> rows;
  size_t cached = 0, width = 0;
  ForRequired(report, [&](const choreo::Obligation& o, const Proof& p) {
    rows[o.kind].Add(p);
    cached += p.cached ? 1 : 0;
    width = std::max(width, Words(o.kind).size());
  });
  const Counts total = Total(report);
  std::string text = fmt::format("{}: {} obligations{}\n", report.graph->source->name.text,
                                 total.holds + total.fails + total.open,
                                 cached > 0 ? fmt::format(" ({} known from the cache)", cached) : "");
  for (const auto& [kind, c] : rows) {
    std::string cells = fmt::format("{:>4} ok", c.holds);
    if (c.fails > 0) cells += fmt::format("  {} FAIL", c.fails);
    if (c.open > 0) cells += fmt::format("  {} ?", c.open);
    text += fmt::format("  {:{}}  {:<20} {:8.2f} s\n", Words(kind), width, cells, c.seconds);
  }
  return text;
}

std::string RegionLines(const choreo::Inference& regions, const diag::SourceSet& sources) {
  std::string text;
  for (const choreo::FoundRegion& r : regions.found) {
    text += fmt::format("{}:{}: thread region {}  # {}\n", sources.path(r.span.file),
                        sources.Locate(r.span.file, r.span.begin).line, r.text, r.robots);
  }
  return text;
}

choreo::Inference FindRegions(choreo::Graph& graph, expr::Arena& arena, double seconds,
                              const base::StopToken& stop) {
  ProgressLine line;
  const InterruptScope interrupt(stop);
  choreo::InferOptions infer;
  infer.stop = stop;
  infer.limits.time = std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
  infer.progress = [&](const std::string& robots) { line.Show("looking for regions of " + robots); };
  return choreo::InferRegions(graph, arena, infer);
}

void ReportRegions(const choreo::Inference& regions, diag::Diagnostics& diagnostics) {
  for (const choreo::NoRegion& n : regions.failed) {
    diagnostics.Report(diag::Kind::kChoreoNoRegion, n.span, "no region was found for this thread")
        .Note(n.why)
        .Help("write `thread region ... { ... }`, or let the motions keep farther apart");
  }
}

std::string MotionSummary(const MotionReport& report, const diag::SourceSet& sources) {
  const Counts total = Total(report);
  const auto& proofs = report.proofs.all;
  size_t uncertified = 0;
  for (const Proof& p : proofs) uncertified += p.decision.verdict == Verdict::kProved && !p.certified ? 1 : 0;
  const std::string& name = report.graph->source->name.text;
  std::string text;
  if (!report.obligations.missing.empty()) {
    text = fmt::format("not proved: {}: something is missing\n", name);
  } else if (total.fails > 0) {
    text = fmt::format("not proved: {}: {} of {} obligations fail{}\n", name, total.fails,
                       total.fails + total.holds + total.open,
                       total.open > 0 ? fmt::format(", {} are not decided", total.open) : "");
  } else if (!report.regions.failed.empty()) {
    text = fmt::format("unknown: {}: threads without regions\n", name);
  } else if (total.open > 0) {
    text = fmt::format("unknown: {}: {} of {} obligations are not decided\n", name, total.open,
                       total.holds + total.open);
  } else {
    text = fmt::format("{}: {}: no robots or obstacles ever touch, and every step is as promised\n",
                       uncertified == 0 ? "proved and certified" : "proved", name);
    if (uncertified > 0) text += fmt::format("not certified: {} of {} proofs\n", uncertified, proofs.size());
  }
  if (!report.regions.found.empty())
    text += "regions that were found:\n" + RegionLines(report.regions, sources);
  for (const std::string& a :
       choreo::AssumptionsOf(*report.graph, report.discharged, report.obligations, report.proofs))
    text += fmt::format("assumed: {}\n", a);
  if (!report.discharged.empty()) {
    text += fmt::format("proved by reachability: controllers keep the contracts of {}\n",
                        fmt::join(report.discharged, ", "));
  }
  if (report.interrupted) text += "interrupted: what is marked `?` was not decided\n";
  for (const std::string& problem : report.proofs.problems) text += fmt::format("problem: {}\n", problem);
  return text;
}

nlohmann::json ToJson(const MotionReport& report) {
  nlohmann::json list = nlohmann::json::array();
  for (size_t i = 0; i < report.obligations.all.size(); ++i) {
    const choreo::Obligation& o = report.obligations.all[i];
    const Proof& p = report.proofs.all[i];
    nlohmann::json entry{{"kind", choreo::KindName(o.kind)},
                         {"title", o.title},
                         {"required", choreo::IsRequired(o.kind)},
                         {"verdict", Name(p.decision.verdict)},
                         {"certified", p.certified},
                         {"cached", p.cached},
                         {"seconds", p.seconds}};
    if (!p.cached && p.decision.verdict == Verdict::kProved) entry["way"] = Name(p.decision.way);
    if (!p.decision.reason.empty()) entry["reason"] = p.decision.reason;
    if (p.decision.verdict != Verdict::kProved && !p.decision.witness.values.empty()) {
      entry["state"] = choreo::StateOf(*report.graph, p.decision.witness);
      const std::string place = choreo::PlaceOf(*report.graph, p.decision.witness);
      if (!place.empty()) entry["point"] = place;
      const auto clock = p.decision.witness.values.find(report.graph->world->clock);
      if (clock != p.decision.witness.values.end()) entry["clock"] = clock->second;
    }
    list.push_back(std::move(entry));
  }
  nlohmann::json missing = nlohmann::json::array();
  for (const choreo::Missing& m : report.obligations.missing) missing.push_back(m.what);
  nlohmann::json regions = nlohmann::json::array();
  for (const choreo::FoundRegion& r : report.regions.found)
    regions.push_back({{"robots", r.robots}, {"region", r.text}});
  return {{"choreography", report.graph->source->name.text},
          {"status", StatusOf(report)},
          {"obligations", list},
          {"missing", missing},
          {"problems", report.proofs.problems},
          {"regions", regions},
          {"proved_by_reachability", report.discharged},
          {"assumed",
           choreo::AssumptionsOf(*report.graph, report.discharged, report.obligations, report.proofs)}};
}

}  // namespace rondo::driver
