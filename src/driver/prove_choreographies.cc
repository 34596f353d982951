#include "driver/prove_choreographies.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "contracts/choreography_report.h"
#include "contracts/choreography_scene.h"
#include "contracts/discharge.h"
#include "driver/terminal.h"

namespace rondo::driver {
namespace {

using verdict::ExitStatus;

ExitStatus StatusOf(const contracts::ChoreographyProof& proof) {
  if (proof.proofs.bug) return ExitStatus::kBug;
  const ExitStatus status = verdict::StatusOf(contracts::VerdictOf(proof));
  return proof.proofs.problems.empty() ? status : verdict::Worse(status, ExitStatus::kRejected);
}

class Run {
 public:
  explicit Run(const ProveChoreographiesOptions& options)
      : options_(options),
        cache_(options.cache ? solve::cache::ProofCache::DefaultFolder() : std::filesystem::path()) {}

  ExitStatus operator()() {
    for (const std::string& folder : {options_.smt_out, options_.certificates}) {
      if (const std::string why = Folder(folder); !why.empty())
        return Refuse("prove", options_.files.front(), options_.json, session_.sources, session_.diagnostics,
                      why);
    }
    const auto module = workspace::LoadModule(options_.files, options_.admitted, session_);
    // First of all, as `rondo reach` does: sums are written in the order in which their terms are made.
    std::map<const choreo::Graph*, std::set<std::string>> discharged;
    if (module->declarations != nullptr && !session_.diagnostics.has_errors() && options_.cache)
      discharged = contracts::ProvedMotions(*module, cache_);
    const auto conditions = workspace::CheckStructure(*module, session_);
    if (!conditions || session_.diagnostics.has_errors()) return Finish(ExitStatus::kRejected);
    if (module->graphs.empty()) {
      session_.diagnostics.Report(diag::Kind::kChoreoMissing, {}, "there is no choreography to prove");
      return Finish(ExitStatus::kRejected);
    }
    auto status = ExitStatus::kEstablished;
    for (choreo::Graph& graph : module->graphs) {
      std::vector<choreo::SideCondition> own;
      for (const auto& c : *conditions) {
        if (c.graph == &graph) own.push_back(c);
      }
      proofs_.push_back(Prove(graph, own, std::move(discharged[&graph]), module->arena));
      status = verdict::Worse(status, StatusOf(proofs_.back()));
    }
    if (!options_.svg.empty()) picture_ = contracts::SceneOf(proofs_.front(), module->arena);
    return Finish(status);
  }

 private:
  contracts::ChoreographyProof Prove(choreo::Graph& graph,
                                     const std::vector<choreo::SideCondition>& conditions,
                                     std::set<std::string> discharged, expr::Arena& arena) {
    ProgressLine line;
    const InterruptScope interrupt(stop_);
    contracts::ChoreographyOptions prove;
    prove.stop = stop_;
    prove.timeout = options_.timeout;
    prove.jobs = options_.jobs;
    prove.certify = options_.certify;
    prove.cache = options_.cache ? &cache_ : nullptr;
    prove.smt_out = options_.smt_out;
    prove.certificates = options_.certificates;
    prove.progress = [&](const std::string& what) { line.Show(what); };
    return contracts::ProveChoreography(graph, arena, conditions, std::move(discharged), prove,
                                        session_.diagnostics);
  }

  ExitStatus Finish(ExitStatus status) {
    if (!picture_.empty())
      status = verdict::Worse(status, WritePicture(options_.svg, picture_, options_.json));
    if (options_.json) {
      nlohmann::json list = nlohmann::json::array();
      for (const auto& proof : proofs_) list.push_back(ToJson(proof, session_.sources));
      PrintJson({{"command", "prove"},
                 {"status", status},
                 {"choreographies", list},
                 {"diagnostics", diag::RenderJson(session_.sources, session_.diagnostics)}});
      return status;
    }
    for (const auto& proof : proofs_) Print(contracts::ChoreographyTable(proof));
    if (!session_.diagnostics.all().empty()) {
      if (!proofs_.empty()) Print("\n");
      PrintDiagnostics(session_.sources, session_.diagnostics);
    }
    if (!proofs_.empty()) Print("\n");
    for (const auto& proof : proofs_) Print(contracts::ChoreographySummary(proof, session_.sources));
    PrintStatus(status);
    return status;
  }

  const ProveChoreographiesOptions& options_;
  const solve::cache::ProofCache cache_;
  workspace::Session session_;
  base::StopToken stop_;  // of all choreographies
  std::vector<contracts::ChoreographyProof> proofs_;
  std::string picture_;
};

}  // namespace

ExitStatus ProveChoreographies(const ProveChoreographiesOptions& options) { return Run(options)(); }

}  // namespace rondo::driver
