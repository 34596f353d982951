#include "driver/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/tube_certificate.h"

namespace rondo::driver {

namespace {

class Sweeper {
 public:
  Sweeper(const ContractResult& contract, size_t state, const DecideOptions& options,
          const base::StopToken& stop, const base::StopToken& cancelled, double shortest)
      : problem_(contract.made.problem),
        state_(state),
        options_(options),
        stop_(stop),
        cancelled_(cancelled),
        shortest_(shortest) {}

  void Run(interval::Interval range) {
    SweepPart part{range.lo, range.hi, "unknown", 0, "", false};
    const double middle = range.Middle();
    const bool last = range.Width() <= shortest_ * 1.5 || middle <= range.lo || middle >= range.hi;
    if (!stop_.StopRequested()) Decide(part, last);
    const bool split = part.verdict != "proved" && !last && !stop_.StopRequested();
    if (!split) {
      Add(std::move(part));
      return;
    }
    Run({range.lo, middle});
    Run({middle, range.hi});
  }

  std::vector<SweepPart> parts;

 private:
  void Decide(SweepPart& part, bool last) {
    reach::Problem problem = problem_;
    problem.initial[state_] = {part.from, part.to};
    for (size_t i = 0; i < problem.copy_of.size(); ++i) {
      if (problem.copy_of[i] == state_) problem.initial[i] = problem.initial[state_];
    }
    reach::ProverOptions prover;
    prover.jobs = options_.jobs;
    prover.seed = options_.seed;
    prover.keep_tube = false;
    // Short parts of the range are better than many parts of everything else.
    prover.most_leaves = last ? 64 : 1;
    prover.samples = 40;
    const auto outcome = reach::Decide(problem, prover, stop_);
    if (options_.progress) options_.progress(parts.size(), 1);
    if (!outcome.ok()) return;
    if (const auto* proved = std::get_if<reach::Proved>(&outcome.value())) {
      part.verdict = "proved";
      // What is proved in time is certified, even if time is over by then.
      part.certified =
          options_.certify &&
          reach::certify::Check(problem, CertificateOf(*proved), options_.jobs, cancelled_).accepted;
    }
    if (const auto* refuted = std::get_if<reach::Refuted>(&outcome.value())) {
      part.verdict = "refuted";
      part.counterexample = refuted->course.start[state_];
      part.claim = problem.claims[refuted->violation.claim].name;
    }
  }

  void Add(SweepPart part) {
    if (!parts.empty() && parts.back().verdict == part.verdict && parts.back().certified == part.certified) {
      parts.back().to = part.to;
    } else {
      parts.push_back(std::move(part));
    }
  }

  const reach::Problem& problem_;
  size_t state_;
  const DecideOptions& options_;
  const base::StopToken& stop_;
  const base::StopToken& cancelled_;  ///< without a limit of time
  double shortest_;
};

}  // namespace

Sweep SweepContract(const ContractResult& contract, const std::string& parameter, size_t parts,
                    const DecideOptions& options, const base::StopToken& stop) {
  Sweep sweep{contract.made.problem.name, parameter, contract.impossible, {}};
  if (!sweep.trouble.empty()) return sweep;
  const auto& names = contract.made.names;
  const auto it = std::ranges::find(names, parameter);
  if (it == names.end()) {
    sweep.trouble = fmt::format("it has no `{}`", parameter);
    return sweep;
  }
  const auto state = static_cast<size_t>(it - names.begin());
  const interval::Interval range = contract.made.problem.initial[state];
  const base::StopToken limited =
      stop.WithDeadline(std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000)));
  Sweeper sweeper(contract, state, options, limited, stop, range.Width() / static_cast<double>(parts));
  sweeper.Run(range);
  sweep.parts = std::move(sweeper.parts);
  return sweep;
}

std::string ToText(const Sweep& sweep) {
  if (!sweep.trouble.empty()) return fmt::format("{}: {}\n", sweep.contract, sweep.trouble);
  std::string text = fmt::format("{}\n", sweep.contract);
  for (const SweepPart& part : sweep.parts) {
    text += fmt::format("  {} in [{:.6g}, {:.6g}]  {}", sweep.parameter, part.from, part.to, part.verdict);
    if (part.certified) text += " and certified";
    if (part.verdict == "refuted")
      text += fmt::format(", for example {:.6g}: `{}`", part.counterexample, part.claim);
    text += '\n';
  }
  return text;
}

nlohmann::json ToJson(const Sweep& sweep) {
  nlohmann::json out{{"contract", sweep.contract}, {"parameter", sweep.parameter}};
  if (!sweep.trouble.empty()) out["reason"] = sweep.trouble;
  nlohmann::json list = nlohmann::json::array();
  for (const SweepPart& part : sweep.parts) {
    nlohmann::json one{{"from", part.from}, {"to", part.to}, {"verdict", part.verdict}};
    if (part.verdict == "proved") one["certified"] = part.certified;
    if (part.verdict == "refuted") {
      one["counterexample"] = part.counterexample;
      one["claim"] = part.claim;
    }
    list.push_back(std::move(one));
  }
  out["parts"] = list;
  return out;
}

int StatusOf(const Sweep& sweep) {
  int status = sweep.parts.empty() ? kUndecided : kEstablished;
  for (const SweepPart& part : sweep.parts) {
    if (part.verdict == "refuted") return kRejected;
    if (part.verdict != "proved") status = kUndecided;
  }
  return status;
}

}  // namespace rondo::driver
