#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/interrupt.h"
#include "driver/reachability.h"
#include "driver/terminal.h"
#include "driver/verbs.h"

namespace rondo::driver {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string contract;
  double timeout = 60;
  unsigned jobs = 0;
  uint64_t seed = 1;
  bool json = false;
};

class Run {
 public:
  explicit Run(const Options& options) : options_(options) {}

  int operator()() {
    const auto motion = LoadMotion(options_.files, {}, session_);
    if (motion == nullptr) return kRejected;
    if (motion->declarations == nullptr || session_.diagnostics.has_errors()) return Finish(kRejected);
    results_ = ContractsOf(*motion, session_);
    if (session_.diagnostics.has_errors()) return Finish(kRejected);
    if (!options_.contract.empty()) {
      std::erase_if(results_, [&](const ContractResult& r) {
        return r.made.problem.name.find(options_.contract) == std::string::npos;
      });
    }
    if (results_.empty()) {
      session_.diagnostics
          .Report(diag::Kind::kReachUnknown, {},
                  options_.contract.empty() ? "there is no contract to look at"
                                            : fmt::format("no contract is called `{}`", options_.contract))
          .Help("the motions of a choreography; or of robot types, if their parameters have values or ranges");
      return Finish(kRejected);
    }
    {
      ProgressLine line;
      const InterruptScope interrupt(stop_);
      for (size_t i = 0; i < results_.size(); ++i) Decide(i, line);
    }
    int status = kEstablished;
    for (const ContractResult& r : results_) {
      ReportContract(r, session_.diagnostics);
      const int own = StatusOf(r);
      if (own == kRejected || (own == kUndecided && status == kEstablished)) status = own;
    }
    return Finish(status);
  }

 private:
  void Decide(size_t index, ProgressLine& line) {
    ContractResult& r = results_[index];
    if (!r.impossible.empty() || stop_.cancelled()) return;
    reach::ProverOptions prover;
    prover.jobs = options_.jobs;
    prover.seed = options_.seed;
    prover.progress = [&](size_t done, size_t open) {
      line.Show(fmt::format("[{}/{}] {}: {} parts proved, {} open", index + 1, results_.size(), r.made.problem.name, done, open));
    };
    line.Show(fmt::format("[{}/{}] {}", index + 1, results_.size(), r.made.problem.name));
    const auto begin = std::chrono::steady_clock::now();
    const base::StopToken stop =
        stop_.WithDeadline(begin + std::chrono::milliseconds(static_cast<int64_t>(options_.timeout * 1000)));
    auto outcome = reach::Decide(r.made.problem, prover, stop);
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (outcome.ok()) {
      r.outcome = std::move(outcome).value();
    } else {
      r.impossible = outcome.error().message;
    }
  }

  int Finish(int status) {
    if (options_.json) {
      nlohmann::json list = nlohmann::json::array();
      for (const ContractResult& r : results_) list.push_back(ToJson(r));
      PrintJson({{"command", "reach"},
                 {"status", status},
                 {"contracts", list},
                 {"diagnostics", DiagnosticsToJson(session_.sources, session_.diagnostics)}});
      return status;
    }
    if (!results_.empty()) Print(ContractTable(results_));
    if (!session_.diagnostics.all().empty()) {
      if (!results_.empty()) Print("\n");
      PrintDiagnostics(session_.sources, session_.diagnostics);
    }
    if (!results_.empty()) {
      size_t proved = 0;
      for (const ContractResult& r : results_) proved += VerdictOf(r) == "proved" ? 1 : 0;
      Print(fmt::format("\n{} of {} contract{} proved\n", proved, results_.size(), results_.size() == 1 ? "" : "s"));
    }
    if (status != kEstablished) Print(fmt::format("exit {}\n", status));
    return status;
  }

  const Options& options_;
  Session session_;
  base::StopToken stop_;
  std::vector<ContractResult> results_;
};

}  // namespace

void AddReachVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("reach", "prove contracts of motions against the dynamics of robots");
  verb->add_option("FILE", options->files, "robots and choreographies (`.rondo`)")->required();
  verb->add_option("--contract", options->contract, "only contracts whose name contains this");
  verb->add_option("--timeout", options->timeout, "seconds for each contract; default: 60")
      ->check(CLI::Range(0.001, 1e6));
  verb->add_option("--jobs", options->jobs, "threads; default: as many as there are cores");
  verb->add_option("--seed", options->seed, "of the trajectories that look for a violation; default: 1");
  verb->add_flag("--json", options->json, "the result as JSON on standard output");
  verb->footer(
      "example: rondo reach examples/reach/laub_loomis.rondo\n\n"
      "For every state in which a motion may begin, every parameter and every input: does the robot keep the motion's "
      "contract\nunder its dynamics and controller (docs/reach.md)?\n"
      "exit status: 0 every contract is proved, 1 one is refuted, or the input is wrong, 3 neither");
  verb->callback([options, &status] { status = Run(*options)(); });
}

}  // namespace rondo::driver
