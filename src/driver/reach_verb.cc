#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "contracts/decide_all.h"
#include "contracts/ranges.h"
#include "contracts/report.h"
#include "contracts/statistical.h"
#include "contracts/sweep.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "reach/draw/tube.h"
#include "runs/execution_file.h"
#include "runs/run_file.h"
#include "workspace/places.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string spec;
  std::string contract;
  double timeout = 60;
  unsigned jobs = 0;
  uint64_t seed = 1;
  bool statistical = false;
  contracts::StatisticalOptions sampling;
  std::vector<std::string> sweep;  ///< the parameter, its range
  size_t parts = 64;
  std::vector<std::string> ranges;
  std::string between;
  std::string svg, save, certificates;
  bool no_certify = false;
  bool no_cache = false;
  bool json = false;
};

class Run {
 public:
  explicit Run(const Options& options) : options_(options) {}

  ExitStatus operator()() {
    if (!ReadSweep() || !ReadBetween() || !OptionsFit()) return ExitStatus::kRejected;
    if (!Load()) return Finish(ExitStatus::kRejected);
    if (!options_.contract.empty()) {
      std::erase_if(loaded_.results, [&](const contracts::ContractResult& r) {
        return r.made.problem.name.find(options_.contract) == std::string::npos;
      });
    }
    if (loaded_.results.empty()) {
      session_.diagnostics
          .Report(diag::Kind::kReachUnknown, {},
                  options_.contract.empty() ? "there is no contract to look at"
                                            : fmt::format("no contract is called `{}`", options_.contract))
          .Help(
              "the motions of a choreography; or of robot types, if their parameters have values or ranges; of a Koord program, the "
              "assumptions about modules with a `platform`");
      return Finish(ExitStatus::kRejected);
    }
    if (options_.statistical) return SampleAll();
    if (loose_) return SweepAll();
    contracts::DecideAllOptions deciding{
        {options_.timeout, options_.jobs, options_.seed, !options_.no_certify, {}},
        options_.files,
        options_.spec,
        options_.certificates,
        options_.ranges,
        between_,
        {},
        [this](size_t i) { Keep(i); }};
    {
      ProgressLine line;
      const InterruptScope interrupt(stop_);
      deciding.progress = [&](const std::string& what) { line.Show(what); };
      decided_.emplace(loaded_, deciding, cache_);
      decided_->Run(stop_);
      for (const std::string& failure : decided_->failures()) PrintFailure(failure);
    }
    ExitStatus status = ExitStatus::kEstablished;
    for (const contracts::ContractResult& r : loaded_.results) {
      contracts::ReportContract(r, session_.diagnostics);
      status = verdict::Worse(status, verdict::StatusOf(contracts::VerdictOf(r)));
    }
    if (!decided_->failures().empty() || decided_->wrong_range()) status = ExitStatus::kRejected;
    status = Finish(status);
    for (const auto& [path, svg] : pictures_) {
      if (WritePicture(path, svg, options_.json) != ExitStatus::kEstablished) status = ExitStatus::kRejected;
    }
    return status;
  }

 private:
  bool Load() {
    const bool reduce = options_.ranges.empty();  // else places are asked about
    return contracts::LoadContracts(options_.files, options_.spec, loose_ ? &*loose_ : nullptr, reduce,
                                    session_, loaded_);
  }

  // NAME FROM..TO
  bool ReadSweep() {
    if (options_.sweep.empty()) return true;
    const auto range = contracts::ReadRange(options_.sweep[1]);
    if (!range || range->first == range->second) {
      PrintFailure(fmt::format("`--sweep` takes a name and a range, as in `--sweep gain 0.5..4`: not `{}`",
                               options_.sweep[1]));
      return false;
    }
    loose_ = robot::Loose{options_.sweep[0], range->first, range->second};
    return true;
  }

  bool OptionsFit() const {
    const bool asked = !options_.ranges.empty();
    if (asked && (loose_ || options_.statistical)) {
      PrintFailure("`--range` is about proofs: neither with `--sweep` nor with `--statistical`");
      return false;
    }
    if (!asked && between_) PrintFailure("`--between` belongs to `--range`");
    return asked || !between_;
  }

  // FROM..TO
  bool ReadBetween() {
    if (options_.between.empty()) return true;
    between_ = contracts::ReadRange(options_.between);
    if (!between_)
      PrintFailure(
          fmt::format("`--between` takes seconds, as in `--between 0.5..4`: not `{}`", options_.between));
    return between_.has_value();
  }

  ExitStatus SweepAll() {
    ExitStatus status = ExitStatus::kEstablished;
    size_t with = 0;
    nlohmann::json list = nlohmann::json::array();
    std::string text;
    {
      ProgressLine line;
      const InterruptScope interrupt(stop_);
      for (contracts::ContractResult& r : loaded_.results) {
        const auto it = std::ranges::find(r.made.names, loose_->name);
        if (it == r.made.names.end()) continue;
        ++with;
        // What is known of it is known for less: a part of its own range.
        interval::Interval& side = r.made.problem.initial[static_cast<size_t>(it - r.made.names.begin())];
        side = interval::Meet(side, {loose_->least.ToDouble(), loose_->most.ToDouble()});
        contracts::DecideOptions options{
            options_.timeout, options_.jobs, options_.seed, !options_.no_certify, {}};
        options.swept = [&](double share, double from, double to) {
          line.Show(fmt::format("{}: {:.0f} % of the range decided, now {} in [{:.6g}, {:.6g}]",
                                r.made.problem.name, 100 * share, loose_->name, from, to));
        };
        if (side.IsEmpty()) r.impossible = fmt::format("`{}` is never in this range", loose_->name);
        const contracts::Sweep sweep =
            contracts::SweepContract(r, loose_->name, options_.parts, options, stop_);
        status = verdict::Worse(status, verdict::StatusOf(contracts::VerdictOf(sweep)));
        list.push_back(ToJson(sweep));
        text += ToText(sweep);
      }
    }
    if (with == 0) {
      PrintFailure(
          fmt::format("no contract depends on `{}`: name a parameter of a robot, or of a motion, or a state",
                      loose_->name));
      return ExitStatus::kRejected;
    }
    if (options_.json) {
      PrintJson({{"command", "reach"}, {"status", status}, {"sweeps", list}});
    } else {
      Print(text);
      PrintStatus(status);
    }
    return status;
  }

  // Refutations as files that replay, and pictures.
  void Keep(size_t index) {
    contracts::ContractResult& r = loaded_.results[index];
    if (!r.outcome) return;
    if (const auto* refuted = std::get_if<reach::Refuted>(&*r.outcome)) {
      const std::string path = options_.save.empty()
                                   ? workspace::DefaultRunFile(options_.files[0], r.made.problem.name)
                                   : Numbered(options_.save, index);
      const runs::ExecutionFile file{
          options_.files,      options_.spec,
          r.made.problem.name, r.made.problem.claims[refuted->violation.claim].name,
          refuted->execution,  refuted->violation.time};
      const auto written = runs::SaveExecution(path, file);
      if (written.ok()) {
        saved_.push_back(path);
      } else {
        PrintFailure(fmt::format("cannot write `{}`: {}", path, written.error().message));
      }
    }
    if (options_.svg.empty()) return;
    reach::TubePicture picture{r.made.names};
    picture.seed = options_.seed;
    const auto svg = reach::DrawTube(r.made.problem, *r.outcome, picture, stop_);
    if (svg.ok()) pictures_.emplace_back(Numbered(options_.svg, index), svg.value());
  }

  // `tube.svg`, or `tube-2.svg` if there are several contracts.
  std::string Numbered(const std::string& path, size_t index) const {
    if (loaded_.results.size() < 2) return path;
    const std::filesystem::path p(path);
    return (p.parent_path() / fmt::format("{}-{}{}", p.stem().string(), index + 1, p.extension().string()))
        .string();
  }

  // Samples establish nothing: a failure refutes, anything else stays open.
  ExitStatus SampleAll() {
    contracts::StatisticalOptions sampling = options_.sampling;
    sampling.jobs = options_.jobs;
    sampling.seed = options_.seed;
    ExitStatus status = ExitStatus::kUndecided;
    nlohmann::json list = nlohmann::json::array();
    const InterruptScope interrupt(stop_);
    for (const contracts::ContractResult& r : loaded_.results) {
      const contracts::Statistical s = contracts::Sample(r, sampling, stop_);
      // That a run leaves a tube that was learned from others says nothing about the contract.
      if (s.failures + s.corner_failures > 0 && sampling.tube.empty()) status = ExitStatus::kRejected;
      if (options_.json) {
        list.push_back(ToJson(r, s, sampling));
      } else {
        Print(contracts::StatisticalLine(r, s));
      }
    }
    if (options_.json) {
      PrintJson({{"command", "reach"}, {"status", status}, {"contracts", list}});
    } else {
      Print(fmt::format("seed {}; starts drawn uniformly from initial boxes; nothing is proved\n",
                        sampling.seed));
      PrintStatus(status);
    }
    return status;
  }

  ExitStatus Finish(ExitStatus status) {
    const std::vector<contracts::Ranges> ranges =
        decided_ ? decided_->ranges() : std::vector<contracts::Ranges>();
    const std::vector<std::string> certificates =
        decided_ ? decided_->certificates() : std::vector<std::string>();
    if (options_.json) {
      nlohmann::json list = nlohmann::json::array();
      for (size_t i = 0; i < loaded_.results.size(); ++i) {
        list.push_back(ToJson(loaded_.results[i]));
        if (i < ranges.size()) list.back()["ranges"] = ToJson(ranges[i]);
      }
      PrintJson({{"command", "reach"},
                 {"status", status},
                 {"contracts", list},
                 {"runs", saved_},
                 {"certificates", certificates},
                 {"left_out", loaded_.left_out},
                 {"diagnostics", diag::RenderJson(session_.sources, session_.diagnostics)}});
      return status;
    }
    if (!loaded_.results.empty()) Print(contracts::ContractTable(loaded_.results));
    for (size_t i = 0; i < ranges.size(); ++i)
      Print(fmt::format("{}:\n{}", loaded_.results[i].made.problem.name, ToText(ranges[i])));
    for (const std::string& motion : loaded_.left_out) Print(fmt::format("not looked at: {}\n", motion));
    if (!session_.diagnostics.all().empty()) {
      if (!loaded_.results.empty()) Print("\n");
      PrintDiagnostics(session_.sources, session_.diagnostics);
    }
    if (!loaded_.results.empty()) {
      size_t proved = 0;
      size_t certified = 0;
      std::set<std::string> assumed;
      for (const contracts::ContractResult& r : loaded_.results) {
        if (VerdictOf(r) != verdict::Verdict::kProved) continue;
        ++proved;
        certified += r.IsCertified() ? 1 : 0;
        if (!r.model.empty())
          Print(fmt::format("{}: proved of `{}`, for {}\n", r.made.problem.name, r.model,
                            fmt::join(r.domain, "; ")));
        assumed.insert(r.made.assumed.begin(), r.made.assumed.end());
      }
      if (!assumed.empty()) Print(fmt::format("assumed: {}\n", fmt::join(assumed, "; ")));
      const bool all = certified == proved && proved > 0;
      Print(fmt::format("{} of {} contract{} proved{}\n", proved, loaded_.results.size(),
                        loaded_.results.size() == 1 ? "" : "s", all ? " and certified" : ""));
      if (!all && proved > 0 && !options_.no_certify)
        Print(fmt::format("certified: {} of {} proofs\n", certified, proved));
    }
    for (const std::string& path : certificates)
      Print(fmt::format("a certificate is in {}: `rondo certify {}`\n", path, path));
    for (const std::string& path : saved_)
      Print(fmt::format("the run is in {}: `rondo replay {}`\n", path, path));
    PrintStatus(status);
    return status;
  }

  const Options& options_;
  workspace::Session session_;
  const solve::cache::ProofCache cache_{options_.no_cache ? std::filesystem::path()
                                                          : solve::cache::ProofCache::DefaultFolder()};
  base::StopToken stop_;
  contracts::LoadedContracts loaded_;
  std::optional<robot::Loose> loose_;
  std::optional<std::pair<expr::Rational, expr::Rational>> between_;
  std::optional<contracts::DecideAll> decided_;
  std::vector<std::string> saved_;
  std::vector<std::pair<std::string, std::string>> pictures_;
};

}  // namespace

void AddReachVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "reach", "prove contracts of motions against the dynamics of robots");
  verb.Option("FILE", options->files, "robots and choreographies (`.rondo`), or a Koord program").Required();
  verb.Option("--spec", options->spec, "the specification of a Koord program, if it is not beside it");
  verb.Option("--contract", options->contract, "only contracts whose name contains this");
  verb.Option("--timeout", options->timeout, "seconds for each contract; default: 60").Between(0.001, 1e6);
  verb.Option("--jobs", options->jobs, "threads; default: as many as there are cores");
  verb.Option("--seed", options->seed, "of the trajectories that look for a violation; default: 1");
  verb.Option("--sweep", options->sweep,
              "a parameter and its range, in SI units: for which of its values do contracts hold?")
      .Takes(2, "NAME FROM..TO");
  verb.Option("--parts", options->parts, "of --sweep: how finely the range is divided, at most; default: 64")
      .Between(size_t{1}, size_t{65536});
  verb.Option("--range", options->ranges,
              "a quantity such as `abs(x - y) + 2 cm`: what it can be, if the contract is proved")
      .OneEach();
  verb.Option("--between", options->between, "of --range: FROM..TO, in seconds; default: all the time");
  verb.Option("--svg", options->svg, "write a picture: tubes, samples, starts and bounds");
  verb.Option("--save", options->save, "where trajectories that break a contract go, for `rondo replay`");
  verb.Flag("--statistical", options->statistical,
            "draw starts at random instead of proving: how many fail at most, with which confidence");
  verb.Option("--runs", options->sampling.runs, "of --statistical; default: 6905 (for 0.001 with 0.999)")
      .Between(size_t{1}, size_t{100'000'000});
  verb.Option("--confidence", options->sampling.confidence, "of --statistical; default: 0.999")
      .Between(0.5, 0.999999999);
  verb.Option(
      "--simulator", options->sampling.simulator,
      "of --statistical: a command or a shared library (.so) that simulates the robot instead of its model (docs/reach.md)");
  verb.Option(
          "--tube", options->sampling.tube,
          "of --statistical: judge a tube that is learned from a few runs, as Verse learns it (`compat`) or with corners and "
          "slack (`careful`)")
      .OneOf({"compat", "careful"});
  verb.Option("--certificates", options->certificates,
              "write the certificate of every proof into this folder, for `rondo certify`");
  verb.Flag("--no-certify", options->no_certify, "do not have proofs checked by the independent checker");
  verb.Flag("--no-cache", options->no_cache, "do not remember for `rondo prove` what is proved");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo reach examples/reach/laub_loomis.rondo --contract Wide --svg tube.svg\n"
      "  rondo reach models/quadrotor.rondo --contract CrossField --sweep velocity_gain 1.2..2\n"
      "\n"
      "For every state in which a motion may begin, every parameter and every input: does the robot keep the motion's contract\n"
      "under its dynamics and controller (docs/reach.md)?\n"
      "exit status: 0 every contract is proved, 1 one is refuted, or the input is wrong, 3 neither");
  verb.Run([options, &status] { status = Run(*options)(); });
}

}  // namespace rondo::driver
