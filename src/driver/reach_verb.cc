#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "driver/discharge.h"
#include "driver/exit_status.h"
#include "driver/interrupt.h"
#include "driver/reachability.h"
#include "driver/statistical.h"
#include "driver/terminal.h"
#include "driver/verbs.h"

namespace rondo::driver {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string spec;
  std::string contract;
  double timeout = 60;
  unsigned jobs = 0;
  uint64_t seed = 1;
  bool statistical = false;
  StatisticalOptions sampling;
  bool no_cache = false;
  bool json = false;
};

class Run {
 public:
  explicit Run(const Options& options) : options_(options) {}

  int operator()() {
    if (!Load()) return Finish(kRejected);
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
          .Help(
              "the motions of a choreography; or of robot types, if their parameters have values or ranges; "
              "of a Koord "
              "program, the assumptions about modules with a `platform`");
      return Finish(kRejected);
    }
    if (options_.statistical) return SampleAll();
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
  bool Load() {
    if (options_.files.size() == 1 && !IsMotionFile(options_.files[0])) {
      koord_ = LoadKoord({options_.files[0], options_.spec}, session_);
      if (koord_ == nullptr) return false;
      results_ = PortContractsOf(*koord_, platforms_, session_);
    } else {
      motion_ = LoadMotion(options_.files, {}, session_);
      if (motion_ == nullptr || motion_->declarations == nullptr || session_.diagnostics.has_errors())
        return false;
      results_ = ContractsOf(*motion_);
    }
    return !session_.diagnostics.has_errors();
  }

  void Decide(size_t index, ProgressLine& line) {
    ContractResult& r = results_[index];
    const std::string& name = r.made.problem.name;
    DecideOptions options{options_.timeout, options_.jobs, options_.seed, {}};
    options.progress = [&](size_t done, size_t open) {
      line.Show(
          fmt::format("[{}/{}] {}: {} parts proved, {} open", index + 1, results_.size(), name, done, open));
    };
    line.Show(fmt::format("[{}/{}] {}", index + 1, results_.size(), name));
    DecideContract(r, options, stop_);
    StoreProved(r, cache_);
  }

  // Samples establish nothing: a failure refutes, anything else stays open.
  int SampleAll() {
    StatisticalOptions sampling = options_.sampling;
    sampling.jobs = options_.jobs;
    sampling.seed = options_.seed;
    int status = kUndecided;
    nlohmann::json list = nlohmann::json::array();
    const InterruptScope interrupt(stop_);
    for (const ContractResult& r : results_) {
      const Statistical s = Sample(r, sampling, stop_);
      if (s.failures + s.corner_failures > 0) status = kRejected;
      if (options_.json) {
        list.push_back(ToJson(r, s, sampling));
      } else {
        Print(StatisticalLine(r, s));
      }
    }
    if (options_.json) {
      PrintJson({{"command", "reach"}, {"status", status}, {"contracts", list}});
    } else {
      Print(fmt::format("seed {}; starts drawn uniformly from initial boxes; nothing is proved\nexit {}\n",
                        sampling.seed, status));
    }
    return status;
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
      std::set<std::string> assumed;
      for (const ContractResult& r : results_) {
        if (VerdictOf(r) != "proved") continue;
        ++proved;
        if (!r.model.empty())
          Print(fmt::format("{}: proved of `{}`, for {}\n", r.made.problem.name, r.model,
                            fmt::join(r.domain, "; ")));
        assumed.insert(r.made.assumed.begin(), r.made.assumed.end());
      }
      if (!assumed.empty()) Print(fmt::format("assumed: {}\n", fmt::join(assumed, "; ")));
      Print(fmt::format("{} of {} contract{} proved\n", proved, results_.size(),
                        results_.size() == 1 ? "" : "s"));
    }
    if (status != kEstablished) Print(fmt::format("exit {}\n", status));
    return status;
  }

  const Options& options_;
  Session session_;
  std::unique_ptr<LoadedKoord> koord_;
  std::unique_ptr<Motion> motion_;
  Platforms platforms_;
  const solve::cache::ProofCache cache_{options_.no_cache ? std::filesystem::path()
                                                          : solve::cache::ProofCache::DefaultFolder()};
  base::StopToken stop_;
  std::vector<ContractResult> results_;
};

}  // namespace

void AddReachVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("reach", "prove contracts of motions against the dynamics of robots");
  verb->add_option("FILE", options->files, "robots and choreographies (`.rondo`), or a Koord program")
      ->required();
  verb->add_option("--spec", options->spec, "the specification of a Koord program, if it is not beside it");
  verb->add_option("--contract", options->contract, "only contracts whose name contains this");
  verb->add_option("--timeout", options->timeout, "seconds for each contract; default: 60")
      ->check(CLI::Range(0.001, 1e6));
  verb->add_option("--jobs", options->jobs, "threads; default: as many as there are cores");
  verb->add_option("--seed", options->seed, "of the trajectories that look for a violation; default: 1");
  verb->add_flag("--statistical", options->statistical,
                 "draw starts at random instead of proving: how many fail at most, with which confidence");
  verb->add_option("--runs", options->sampling.runs, "of --statistical; default: 6905 (for 0.001 with 0.999)")
      ->check(CLI::Range(size_t{1}, size_t{100'000'000}));
  verb->add_option("--confidence", options->sampling.confidence, "of --statistical; default: 0.999")
      ->check(CLI::Range(0.5, 0.999999999));
  verb->add_option(
      "--simulator", options->sampling.simulator,
      "of --statistical: a command that simulates the robot instead of its model (docs/reach.md)");
  verb->add_flag("--no-cache", options->no_cache, "do not remember for `rondo prove` what is proved");
  verb->add_flag("--json", options->json, "the result as JSON on standard output");
  verb->footer(
      "example: rondo reach examples/reach/laub_loomis.rondo\n\n"
      "For every state in which a motion may begin, every parameter and every input: does the robot keep the "
      "motion's "
      "contract\nunder its dynamics and controller (docs/reach.md)?\n"
      "exit status: 0 every contract is proved, 1 one is refuted, or the input is wrong, 3 neither");
  verb->callback([options, &status] { status = Run(*options)(); });
}

}  // namespace rondo::driver
