#include "contracts/choreography.h"

#include <fmt/format.h>

#include <chrono>

#include "choreo/prove/runs.h"

namespace rondo::contracts {

using verdict::Verdict;

choreo::Inference FindRegions(choreo::Graph& graph, expr::Arena& arena, const ChoreographyOptions& options) {
  choreo::InferOptions infer;
  infer.stop = options.stop;
  infer.limits.time = std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000));
  infer.progress = [&](const std::string& robots) {
    if (options.progress) options.progress("looking for regions of " + robots);
  };
  return choreo::InferRegions(graph, arena, infer);
}

void ReportRegions(const choreo::Inference& regions, diag::Diagnostics& diagnostics) {
  for (const choreo::NoRegion& n : regions.failed) {
    diagnostics.Report(diag::Kind::kChoreoNoRegion, n.span, "no region was found for this thread")
        .Note(n.why)
        .Help("write `thread region ... { ... }`, or let the motions keep farther apart");
  }
}

ChoreographyProof ProveChoreography(choreo::Graph& graph, expr::Arena& arena,
                                    const std::vector<choreo::SideCondition>& conditions,
                                    std::set<std::string> discharged, const ChoreographyOptions& options,
                                    diag::Diagnostics& diagnostics) {
  ChoreographyProof proof;
  proof.graph = &graph;
  proof.regions = FindRegions(graph, arena, options);
  proof.discharged = std::move(discharged);
  proof.obligations = choreo::ObligationsOf(graph, arena, conditions, proof.discharged);
  // Said below, with the reason.
  if (!proof.regions.failed.empty())
    std::erase_if(proof.obligations.missing, [](const choreo::Missing& m) { return m.region; });
  choreo::ProveOptions prove;
  prove.limits.time = std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000));
  prove.limits.certificates = options.certify;
  prove.jobs = options.jobs;
  prove.cache = options.cache;
  prove.smt_out = options.smt_out;
  prove.certificates = options.certificates;
  prove.stop = options.stop;
  prove.progress = [&](size_t done, size_t total, const std::string& what) {
    if (options.progress) options.progress(fmt::format("[{}/{}] {}", done, total, what));
  };
  proof.proofs = choreo::Prove(proof.obligations, graph, arena, prove);
  proof.interrupted = options.stop.cancelled();
  choreo::ConfirmWitnesses(proof.obligations, arena, proof.proofs);
  if (options.progress && CountsOf(proof).fails > 0) options.progress("looking for runs");
  choreo::FindRuns(proof.obligations, graph, arena, proof.discharged, prove, proof.proofs);
  choreo::ReportProofs(graph, proof.obligations, proof.proofs, diagnostics);
  ReportRegions(proof.regions, diagnostics);
  return proof;
}

void Counts::Add(const choreo::Proof& proof) {
  const Verdict verdict = proof.decision.verdict;
  (verdict == Verdict::kProved ? holds : verdict::Fails(verdict) ? fails : open) += 1;
  if (verdict == Verdict::kNotInductive) ++not_inductive;
  seconds += proof.seconds;
}

Counts CountsOf(const ChoreographyProof& proof) {
  Counts total;
  for (size_t i = 0; i < proof.obligations.all.size(); ++i) {
    if (choreo::IsRequired(proof.obligations.all[i].kind)) total.Add(proof.proofs.all[i]);
  }
  return total;
}

Verdict VerdictOf(const ChoreographyProof& proof) {
  const Counts total = CountsOf(proof);
  if (total.fails > total.not_inductive || !proof.obligations.missing.empty()) return Verdict::kRefuted;
  if (total.not_inductive > 0) return Verdict::kNotInductive;
  if (total.open > 0 || !proof.regions.failed.empty()) return Verdict::kUnknown;
  return Verdict::kProved;
}

verdict::Basis BasisOf(const ChoreographyProof& proof) {
  verdict::Basis basis;
  basis.assumed = choreo::AssumptionsOf(*proof.graph, proof.discharged, proof.obligations, proof.proofs);
  for (const std::string& motion : proof.discharged)
    basis.proved.push_back({motion, verdict::Engine::kReachability, {}});
  return basis;
}

}  // namespace rondo::contracts
