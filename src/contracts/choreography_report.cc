#include "contracts/choreography_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "diag/render.h"

namespace rondo::contracts {

using choreo::ObligationKind;
using choreo::Proof;
using verdict::Verdict;

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

}  // namespace

std::string ChoreographyTable(const ChoreographyProof& report) {
  std::map<ObligationKind, Counts> rows;
  size_t cached = 0, width = 0;
  Counts total;
  for (size_t i = 0; i < report.obligations.all.size(); ++i) {
    const ObligationKind kind = report.obligations.all[i].kind;
    if (!choreo::IsRequired(kind)) continue;
    const Proof& proof = report.proofs.all[i];
    total.Add(proof);
    rows[kind].Add(proof);
    cached += proof.cached ? 1 : 0;
    width = std::max(width, Words(kind).size());
  }
  std::string text = fmt::format("{}: {} obligations{}\n", report.graph->source->name.text, total.All(),
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

std::string ChoreographySummary(const ChoreographyProof& report, const diag::SourceSet& sources) {
  const Counts total = CountsOf(report);
  const auto& proofs = report.proofs.all;
  size_t uncertified = 0;
  for (const Proof& p : proofs) uncertified += p.decision.verdict == Verdict::kProved && !p.certified ? 1 : 0;
  const std::string& name = report.graph->source->name.text;
  std::string text;
  if (!report.obligations.missing.empty()) {
    text = fmt::format("not proved: {}: something is missing\n", name);
  } else if (total.fails > 0) {
    text = fmt::format("not proved: {}: {} of {} obligations fail{}\n", name, total.fails, total.All(),
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
  for (const std::string& a : BasisOf(report).assumed) text += fmt::format("assumed: {}\n", a);
  if (!report.discharged.empty()) {
    text += fmt::format("proved by reachability: controllers keep the contracts of {}\n",
                        fmt::join(report.discharged, ", "));
  }
  if (report.interrupted) text += "interrupted: what is marked `?` was not decided\n";
  for (const std::string& problem : report.proofs.problems) text += fmt::format("problem: {}\n", problem);
  return text;
}

nlohmann::json ToJson(const ChoreographyProof& report, const diag::SourceSet& sources) {
  nlohmann::json list = nlohmann::json::array();
  std::map<std::string, size_t> seen;
  for (size_t i = 0; i < report.obligations.all.size(); ++i) {
    const choreo::Obligation& o = report.obligations.all[i];
    const Proof& p = report.proofs.all[i];
    const std::string kind(choreo::KindName(o.kind));
    std::string id = fmt::format("{}/{}/{}", report.graph->source->name.text, kind, o.title);
    if (const size_t n = ++seen[id]; n > 1) id += fmt::format("#{}", n);
    nlohmann::json entry{{"id", id},
                         {"kind", kind},
                         {"title", o.title},
                         {"required", choreo::IsRequired(o.kind)},
                         {"verdict", verdict::Name(p.decision.verdict)},
                         {"certified", p.certified},
                         {"cached", p.cached},
                         {"seconds", p.seconds}};
    if (!p.cached && p.decision.verdict == Verdict::kProved) entry["way"] = Name(p.decision.way);
    if (o.span.file.valid()) entry["place"] = diag::SpanJson(sources, o.span);
    if (!p.decision.reason.empty()) entry["reason"] = p.decision.reason;
    for (const choreo::Turn& turn : p.turns) {
      nlohmann::json one{{"what", turn.what}};
      if (turn.span.file.valid()) one["place"] = diag::SpanJson(sources, turn.span);
      entry["way_there"].push_back(std::move(one));
    }
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
          {"verdict", verdict::Name(VerdictOf(report))},
          {"obligations", list},
          {"missing", missing},
          {"problems", report.proofs.problems},
          {"regions", regions},
          {"rests_on", verdict::ToJson(BasisOf(report))}};
}

}  // namespace rondo::contracts
