#include "contracts/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <nlohmann/json.hpp>

#include "contracts/tube_certificate.h"
#include "reach/problem/bounds.h"

namespace rondo::contracts {

using verdict::Verdict;

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

  // Wide parts first, and what is hard last: what time is left for decides how sharp the boundary is, not how
  // far one comes. Short parts of the range are better than many parts of everything else.
  void Run(interval::Interval range) {
    struct Task {
      interval::Interval range;
      size_t leaves;
    };
    std::deque<Task> open{{range, 1}};
    for (; !open.empty(); open.pop_front()) {
      const auto [next, leaves] = open.front();
      Say(range, next);
      SweepPart part{next.lo, next.hi, Verdict::kUnknown, 0, "", false};
      if (!stop_.StopRequested()) Decide(part, leaves);
      const double middle = next.Middle();
      const bool shortest = next.Width() <= shortest_ * 1.5 || middle <= next.lo || middle >= next.hi;
      if (part.verdict == Verdict::kProved || stop_.StopRequested() ||
          (shortest && (part.verdict != Verdict::kUnknown || leaves >= kMostLeaves))) {
        parts_.push_back(std::move(part));
      } else if (shortest) {
        open.push_back({next, leaves == 1 ? kSomeLeaves : kMostLeaves});
      } else {
        open.push_back({{next.lo, middle}, 1});
        open.push_back({{middle, next.hi}, 1});
      }
    }
  }

  // Ascending, with what is alike as one.
  std::vector<SweepPart> Parts() {
    std::ranges::sort(parts_, {}, &SweepPart::from);
    std::vector<SweepPart> merged;
    for (SweepPart& part : parts_) {
      const bool alike = !merged.empty() && merged.back().verdict == part.verdict &&
                         merged.back().certified == part.certified;
      if (alike) {
        merged.back().to = part.to;
      } else {
        merged.push_back(std::move(part));
      }
    }
    return merged;
  }

 private:
  // How much of the range is decided, and what is looked at.
  void Say(interval::Interval range, interval::Interval next) const {
    if (!options_.swept) return;
    double decided = 0;
    for (const SweepPart& part : parts_) decided += part.to - part.from;
    options_.swept(decided / std::fmax(range.Width(), 1e-300), next.lo, next.hi);
  }

  static constexpr size_t kSomeLeaves = 64;
  static constexpr size_t kMostLeaves = 1024;

  void Decide(SweepPart& part, size_t leaves) {
    reach::Problem problem = problem_;
    problem.initial[state_] = {part.from, part.to};
    Narrow(problem);
    reach::ProverOptions prover;
    prover.jobs = options_.jobs;
    prover.seed = options_.seed;
    prover.keep_tube = false;
    prover.most_leaves = leaves;
    if (leaves == 1) prover.samples = 40;
    const auto outcome = reach::Decide(problem, prover, stop_);
    if (!outcome.ok()) return;
    if (const auto* proved = std::get_if<reach::Proved>(&outcome.value())) {
      part.verdict = Verdict::kProved;
      // What is proved in time is certified, even if time is over by then.
      part.certified =
          options_.certify &&
          reach::certify::Check(problem, CertificateOf(*proved), options_.jobs, cancelled_).accepted;
    }
    if (const auto* refuted = std::get_if<reach::Refuted>(&outcome.value())) {
      part.verdict = Verdict::kRefuted;
      part.counterexample = refuted->execution.start[state_];
      part.claim = problem.claims[refuted->violation.claim].name;
    }
  }

  // What is assumed at the start may relate other states to this one.
  static void Narrow(reach::Problem& problem) {
    interval::Box box = problem.initial;
    (void)reach::Contract(*problem.arena, problem.assume, problem.states, box);
    const bool empty =
        std::ranges::any_of(box, [](const interval::Interval& side) { return side.IsEmpty(); });
    if (!empty) problem.initial = std::move(box);
    for (size_t i = 0; i < problem.copy_of.size(); ++i) {
      if (problem.copy_of[i]) problem.initial[i] = problem.initial[*problem.copy_of[i]];
    }
  }

  const reach::Problem& problem_;
  size_t state_;
  const DecideOptions& options_;
  const base::StopToken& stop_;
  const base::StopToken& cancelled_;  ///< without a limit of time
  double shortest_;
  std::vector<SweepPart> parts_;
};

}  // namespace

Sweep SweepContract(const ContractResult& contract, const std::string& parameter, size_t parts,
                    const DecideOptions& options, const base::StopToken& stop) {
  Sweep sweep{.contract = contract.made.problem.name, .parameter = parameter, .trouble = contract.impossible};
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
  sweep.parts = sweeper.Parts();
  sweep.out_of_time = limited.StopRequested() && !stop.cancelled();
  sweep.stopped = stop.cancelled();
  return sweep;
}

std::string ToText(const Sweep& sweep) {
  if (!sweep.trouble.empty()) return fmt::format("{}: {}\n", sweep.contract, sweep.trouble);
  std::string text = fmt::format("{}\n", sweep.contract);
  for (const SweepPart& part : sweep.parts) {
    text += fmt::format("  {} in [{:.6g}, {:.6g}]  {}", sweep.parameter, part.from, part.to,
                        verdict::Name(part.verdict));
    if (part.certified) text += " and certified";
    if (part.verdict == Verdict::kRefuted)
      text += fmt::format(", for example {:.6g}: `{}`", part.counterexample, part.claim);
    text += '\n';
  }
  if (sweep.out_of_time) text += "  out of time (--timeout)\n";
  if (sweep.stopped) text += "  stopped\n";
  return text;
}

nlohmann::json ToJson(const Sweep& sweep) {
  nlohmann::json out{{"contract", sweep.contract}, {"parameter", sweep.parameter}};
  if (!sweep.trouble.empty()) out["reason"] = sweep.trouble;
  if (sweep.out_of_time) out["reason"] = "out of time (--timeout)";
  if (sweep.stopped) out["reason"] = "stopped";
  nlohmann::json list = nlohmann::json::array();
  for (const SweepPart& part : sweep.parts) {
    nlohmann::json one{{"from", part.from}, {"to", part.to}, {"verdict", verdict::Name(part.verdict)}};
    if (part.verdict == Verdict::kProved) one["certified"] = part.certified;
    if (part.verdict == Verdict::kRefuted) {
      one["counterexample"] = part.counterexample;
      one["claim"] = part.claim;
    }
    list.push_back(std::move(one));
  }
  out["parts"] = list;
  return out;
}

Verdict VerdictOf(const Sweep& sweep) {
  if (sweep.parts.empty()) return Verdict::kUnknown;
  Verdict all = Verdict::kProved;
  for (const SweepPart& part : sweep.parts) all = verdict::Worse(all, part.verdict);
  return all;
}

}  // namespace rondo::contracts
