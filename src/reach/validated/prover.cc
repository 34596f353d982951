#include "reach/validated/prover.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "reach/validated/runner.h"
#include "reach/validated/search.h"

namespace rondo::reach {

base::Result<std::vector<Interval>> RangesOn(const Problem& problem, const Proved& proved,
                                             const std::vector<Query>& queries, const ProverOptions& options,
                                             const base::StopToken& stop) {
  std::vector<TermId> terms;
  for (const Query& q : queries) terms.push_back(q.term);
  auto made = Stages::Of(problem, std::move(terms));
  if (!made.ok()) return made.error();
  std::vector<std::optional<std::vector<Interval>>> answers(proved.leaves.size());
  base::ParallelFor(proved.leaves.size(), options.jobs, [&](size_t i) {
    answers[i] = Runner(*made.value(), options, options.flow, proved.leaves[i].initial, problem.initial, stop)
                     .Ask(queries);
  });
  std::vector<Interval> all(queries.size(), Interval::Empty());
  for (const auto& one : answers) {
    if (!one) return base::Error{stop.StopRequested() ? "stopped" : "the tube cannot be followed again"};
    for (size_t q = 0; q < all.size(); ++q) all[q] = interval::Hull(all[q], (*one)[q]);
  }
  return all;
}

namespace {

struct Part {
  interval::Box box;
  std::vector<Cut> path;
};

// Both halves of a part; copies of a state have its bounds.
std::vector<Part> Halves(const Problem& problem, const Part& part, size_t side) {
  const Interval whole = part.box[side];
  std::vector<Part> halves;
  for (const bool upper : {false, true}) {
    Part& half = halves.emplace_back(part);
    half.path.push_back({side, upper});
    half.box[side] = upper ? Interval{whole.Middle(), whole.hi} : Interval{whole.lo, whole.Middle()};
    for (size_t k = 0; k < problem.copy_of.size(); ++k) {
      if (problem.copy_of[k] == side) half.box[k] = half.box[side];
    }
  }
  return halves;
}

}  // namespace

verdict::Verdict VerdictOf(const Outcome& outcome) {
  if (std::holds_alternative<Proved>(outcome)) return verdict::Verdict::kProved;
  return std::holds_alternative<Refuted>(outcome) ? verdict::Verdict::kRefuted : verdict::Verdict::kUnknown;
}

base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop) {
  auto made = Stages::Of(problem);
  if (!made.ok()) return made.error();
  Stages& stages = *made.value();
  auto found = Trajectories::Of(problem);
  if (!found.ok()) return found.error();
  Trajectories trajectories = std::move(found).value();
  Search search(stages, options, trajectories, stop);

  std::vector<Part> open{{problem.initial, {}}};
  Proved proved;
  std::string reason;
  bool searched = false;
  // Where events are only possible, tubes are slow: what is plainly false need not wait for them.
  if (!problem.events.empty()) {
    if (auto refuted = search.Run(std::min<size_t>(options.samples, 32))) return Outcome{std::move(*refuted)};
  }
  FlowOptions flow = options.flow;
  size_t done = 0;
  while (!open.empty()) {
    std::vector<Attempt> attempts(open.size());
    base::ParallelFor(open.size(), options.jobs, [&](size_t i) {
      if (stop.StopRequested()) {
        attempts[i].shortfall = verdict::Shortfall::kInterrupted;
        return;
      }
      attempts[i] = Runner(stages, options, flow, open[i].box, problem.initial, stop).Run();
    });
    std::vector<Part> next;
    for (size_t i = 0; i < attempts.size(); ++i) {
      Attempt& a = attempts[i];
      if (a.proved) {
        ++done;
        proved.steps += a.leaf.steps.size();
        if (a.vacuous) {
          proved.empty.push_back(std::move(open[i].path));
        } else {
          a.leaf.path = std::move(open[i].path);
          proved.leaves.push_back(std::move(a.leaf));
        }
        continue;
      }
      reason = a.time > 0 ? fmt::format("{}, at {:.4g} s", a.reason, a.time) : a.reason;
      if (a.shortfall == verdict::Shortfall::kInterrupted) {
        return Outcome{Undecided{"stopped", a.shortfall, search.closest(), std::move(proved.leaves)}};
      }
      if (!a.worst.empty()) {
        if (auto refuted = search.Try(a.worst)) return Outcome{std::move(*refuted)};
      }
      if (!searched) {
        searched = true;
        if (auto refuted = search.Run(options.samples)) return Outcome{std::move(*refuted)};
      }
      const Interval side = open[i].box[a.split];
      const double middle = side.Middle();
      if (side.IsPoint() || middle <= side.lo || middle >= side.hi ||
          side.Width() < 1e-4 * problem.initial[a.split].Width())
        return Outcome{Undecided{reason, a.shortfall, search.closest(), std::move(proved.leaves)}};
      for (Part& half : Halves(problem, open[i], a.split)) next.push_back(std::move(half));
    }
    if (done + next.size() > options.most_leaves)
      return Outcome{Undecided{reason + ", with the most parts that are allowed", verdict::Shortfall::kMethod,
                               search.closest(), std::move(proved.leaves)}};
    open = std::move(next);
    // The whole deserves care; of parts, many cheap ones are better.
    flow.most_monomials = std::min<size_t>(flow.most_monomials, 260);
    flow.linear_tolerance = std::max(flow.linear_tolerance, 0.5);
    if (options.progress) options.progress(done, open.size());
  }
  return Outcome{std::move(proved)};
}

}  // namespace rondo::reach
