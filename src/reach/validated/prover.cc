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

base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop) {
  auto made = Stages::Of(problem);
  if (!made.ok()) return made.error();
  Stages& stages = *made.value();
  auto found = Trajectories::Of(problem);
  if (!found.ok()) return found.error();
  Trajectories trajectories = std::move(found).value();
  Search search(stages, options, trajectories, stop);

  std::vector<interval::Box> open{problem.initial};
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
        attempts[i].reason = "stopped";
        return;
      }
      attempts[i] = Runner(stages, options, flow, open[i], problem.initial, stop).Run();
    });
    std::vector<interval::Box> next;
    for (size_t i = 0; i < attempts.size(); ++i) {
      Attempt& a = attempts[i];
      if (a.proved) {
        ++done;
        proved.steps += a.leaf.steps.size();
        if (a.vacuous) {
          proved.empty.push_back(std::move(open[i]));
        } else {
          proved.leaves.push_back(std::move(a.leaf));
        }
        continue;
      }
      reason = a.time > 0 ? fmt::format("{}, at {:.4g} s", a.reason, a.time) : a.reason;
      if (a.reason == "stopped")
        return Outcome{Undecided{"stopped", search.closest(), std::move(proved.leaves)}};
      if (!a.worst.empty()) {
        if (auto refuted = search.Try(a.worst)) return Outcome{std::move(*refuted)};
      }
      if (!searched) {
        searched = true;
        if (auto refuted = search.Run(options.samples)) return Outcome{std::move(*refuted)};
      }
      const Interval side = open[i][a.split];
      const double middle = side.Middle();
      if (side.IsPoint() || middle <= side.lo || middle >= side.hi ||
          side.Width() < 1e-4 * problem.initial[a.split].Width())
        return Outcome{Undecided{reason, search.closest(), std::move(proved.leaves)}};
      for (const Interval half : {Interval{side.lo, middle}, Interval{middle, side.hi}}) {
        next.push_back(open[i]);
        next.back()[a.split] = half;
        for (size_t k = 0; k < problem.copy_of.size(); ++k) {
          if (problem.copy_of[k] == a.split) next.back()[k] = half;
        }
      }
    }
    if (done + next.size() > options.most_leaves)
      return Outcome{Undecided{reason + ", with the most parts that are allowed", search.closest(),
                               std::move(proved.leaves)}};
    open = std::move(next);
    // The whole deserves care; of parts, many cheap ones are better.
    flow.most_monomials = std::min<size_t>(flow.most_monomials, 260);
    flow.linear_tolerance = std::max(flow.linear_tolerance, 0.5);
    if (options.progress) options.progress(done, open.size());
  }
  return Outcome{std::move(proved)};
}

}  // namespace rondo::reach
