#include "contracts/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace rondo::contracts {

using diag::Kind;

namespace {

std::string StateTable(const ContractResult& r, const std::vector<double>& state) {
  std::string text;
  for (size_t i = 0; i < state.size(); ++i) {
    if (r.made.names[i] == "clock") continue;
    text += fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", r.made.names[i], state[i]);
  }
  return text;
}

const reach::Problem& ProblemOf(const ContractResult& r) { return r.made.problem; }

// How all claims were shown.
const char* MethodOf(const reach::Proved& proved) {
  if (!proved.IsWithoutTube()) return "tube";
  return proved.paving ? "cells" : "invariant";
}

}  // namespace

void ReportContract(const ContractResult& r, diag::Diagnostics& diagnostics) {
  const std::string& name = ProblemOf(r).name;
  if (!r.impossible.empty()) {
    diagnostics
        .Report(Kind::kReachUnknown, r.span, fmt::format("the contract of `{}` cannot be analysed", name))
        .Note(r.impossible);
    return;
  }
  if (!r.outcome) return;
  if (const auto* refuted = std::get_if<reach::Refuted>(&*r.outcome)) {
    const reach::Violation& v = refuted->violation;
    const std::string& claim = ProblemOf(r).claims[v.claim].name;
    auto& report = diagnostics.Report(
        Kind::kReachRefuted, r.span,
        fmt::format("`{}` breaks its contract: `{}` fails after {:.4g} s", name, claim, v.time));
    report.Note(fmt::format("start: {}", StateTable(r, refuted->execution.start)));
    report.Note(fmt::format("there:  {}", StateTable(r, v.state)));
    report.Note(v.miss < 1e299 ? fmt::format("it fails by {:.3g}", v.miss)
                               : std::string("a term of it has no value there"));
    report.Note(refuted->certain
                    ? "the exact solution from this start was enclosed: it does break the contract"
                    : "a simulation, not enclosed: rounding could matter");
    return;
  }
  if (const auto* open = std::get_if<reach::Undecided>(&*r.outcome)) {
    auto& report = diagnostics.Report(
        Kind::kReachUnknown, r.span, fmt::format("the contract of `{}` is neither proved nor refuted", name));
    report.Note(open->reason);
    if (open->closest) {
      report.Note(fmt::format(
          "closest approach of the sampled trajectories: `{}` held by {:.3g} after {:.4g} s",
          ProblemOf(r).claims[open->closest->claim].name, -open->closest->miss, open->closest->time));
    }
  }
}

std::string ContractTable(const std::vector<ContractResult>& results) {
  std::string text =
      fmt::format("{:<9} {:>9} {:>9} {:>6}  {}\n", "verdict", "time", "certified", "parts", "contract");
  std::string rejected;
  for (const ContractResult& r : results) {
    std::string parts;
    std::string note = r.same_as.empty() ? "" : fmt::format(" (as {})", r.same_as);
    const auto* proved = r.outcome ? std::get_if<reach::Proved>(&*r.outcome) : nullptr;
    if (proved != nullptr && !proved->IsWithoutTube()) parts = fmt::format("{}", proved->leaves.size());
    if (proved != nullptr && proved->IsWithoutTube())
      note +=
          proved->paving ? fmt::format(" (by {} cells)", proved->paving->cells.size()) : " (by an invariant)";
    if (!r.anywhere.empty() && r.graph == nullptr && VerdictOf(r) == verdict::Verdict::kProved)
      note += fmt::format(" (whatever {})", fmt::join(r.anywhere, ", "));
    const std::string certified = r.IsCertified() ? fmt::format("{:.3f} s", r.certify_seconds)
                                  : r.certified   ? "no"
                                                  : "";
    text += fmt::format("{:<9} {:>9} {:>9} {:>6}  {}{}\n", Word(r), fmt::format("{:.3f} s", r.seconds),
                        certified, parts, ProblemOf(r).name, note);
    if (r.certified && !r.IsCertified())
      rejected += fmt::format("not certified: {}: {}\n", ProblemOf(r).name, r.certified->reason);
  }
  return text + rejected;
}

nlohmann::json ToJson(const ContractResult& r) {
  nlohmann::json out{{"contract", ProblemOf(r).name}, {"verdict", Word(r)}, {"seconds", r.seconds}};
  if (!r.impossible.empty()) out["reason"] = r.impossible;
  out["rests_on"] = verdict::ToJson(BasisOf(r));
  if (!r.domain.empty()) out["domain"] = r.domain;
  if (!r.model.empty()) out["model"] = r.model;
  if (!r.same_as.empty()) out["same_as"] = r.same_as;
  if (!r.anywhere.empty()) out["whatever"] = r.anywhere;
  if (r.certified) {
    out["certified"] = r.certified->accepted;
    out["certify_seconds"] = r.certify_seconds;
    if (!r.certified->accepted) out["not_certified"] = r.certified->reason;
  }
  if (!r.outcome) return out;
  if (const auto* proved = std::get_if<reach::Proved>(&*r.outcome)) {
    out["method"] = MethodOf(*proved);
    out["parts"] = proved->leaves.size();
    out["steps"] = proved->steps;
    nlohmann::json final = nlohmann::json::object();
    nlohmann::json extent = nlohmann::json::object();
    for (size_t i = 0; i < r.made.names.size(); ++i) {
      interval::Interval end = interval::Interval::Empty();
      interval::Interval all = end;
      for (const reach::Leaf& leaf : proved->leaves) {
        end = interval::Hull(end, leaf.final[i]);
        for (const reach::TubeSegment& s : leaf.tube) all = interval::Hull(all, s.during[i]);
      }
      final[r.made.names[i]] = {end.lo, end.hi};
      extent[r.made.names[i]] = {all.lo, all.hi};
    }
    out["final"] = final;
    out["range"] = extent;
  } else if (const auto* refuted = std::get_if<reach::Refuted>(&*r.outcome)) {
    out["claim"] = ProblemOf(r).claims[refuted->violation.claim].name;
    out["time"] = refuted->violation.time;
    out["fails_by"] = refuted->violation.miss;
    out["start"] = refuted->execution.start;
    out["state"] = refuted->violation.state;
    out["enclosed"] = refuted->certain;
  } else {
    const auto& open = std::get<reach::Undecided>(*r.outcome);
    out["reason"] = open.reason;
    if (open.closest) out["closest"] = {{"held_by", -open.closest->miss}, {"time", open.closest->time}};
  }
  return out;
}

}  // namespace rondo::contracts
