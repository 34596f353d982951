#include "reach/validated/prover.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "reach/invariants/find.h"
#include "reach/problem/bounds.h"
#include "reach/validated/cells.h"
#include "reach/validated/runner.h"
#include "reach/validated/search.h"

namespace rondo::reach {

namespace {

// What terms can be on a box, whatever else is known of the states.
base::Result<std::vector<Interval>> RangesOnBox(const Problem& problem, interval::Box box,
                                                const std::vector<Query>& queries) {
  std::vector<TermId> terms;
  for (const Query& q : queries) terms.push_back(q.term);
  std::vector<TermId> variables = problem.states;
  for (const Input& input : problem.inputs) {
    variables.push_back(input.term);
    box.push_back(input.bounds);
  }
  const auto program = Compile(*problem.arena, std::move(variables), terms);
  if (!program.ok()) return program.error();
  const std::vector<Interval> values = ValuesOn(program.value(), box);
  std::vector<Interval> ranges;
  for (const uint32_t output : program.value().outputs) ranges.push_back(values[output]);
  return ranges;
}

}  // namespace

base::Result<std::vector<Interval>> RangesOn(const Problem& problem, const Proved& proved,
                                             const std::vector<Query>& queries, const ProverOptions& options,
                                             const base::StopToken& stop) {
  std::vector<TermId> terms;
  for (const Query& q : queries) terms.push_back(q.term);
  auto made = Stages::Of(problem, std::move(terms));
  if (!made.ok()) return made.error();
  std::vector<std::optional<std::vector<Interval>>> answers(proved.leaves.size());
  if (proved.IsWithoutTube()) return RangesOnBox(problem, proved.leaves[0].final, queries);
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

namespace {

// By following every part of the initial set.
base::Result<Outcome> DecideByTubes(const Problem& problem, const ProverOptions& options,
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

// With an invariant that implies all claims there is no tube: one part, with a box around the invariant.
Outcome ByInvariant(const Problem& problem, invariants::Found found) {
  Leaf leaf{.initial = problem.initial, .path = {}, .tube = {}, .final = found.states, .steps = {}};
  leaf.tube.push_back({0, Enclose(problem.horizon).hi, std::move(found.states)});
  Proved proved;
  proved.invariant = std::move(found.invariant);
  proved.leaves.push_back(std::move(leaf));
  return proved;
}

// Events and controllers that switch make tubes slow: what is plainly false, and what can be shown without a tube,
// need not wait for them.
base::Result<Outcome> DecideWithSwitches(const Problem& problem, const ProverOptions& options,
                                         const base::StopToken& stop) {
  auto made = Stages::Of(problem);
  if (!made.ok()) return made.error();
  auto compiled = Trajectories::Of(problem);
  if (!compiled.ok()) return compiled.error();
  Trajectories trajectories = std::move(compiled).value();
  Search search(*made.value(), options, trajectories, stop);
  // A few samples for what is plainly false, some more before a tube.
  if (auto refuted = search.Run(std::min<size_t>(options.samples, 8))) return Outcome{std::move(*refuted)};
  if (problem.events.empty()) {
    if (auto proved = ProveByCells(problem, trajectories, options, stop)) return Outcome{std::move(*proved)};
  }
  auto found = invariants::Find(problem, trajectories, options.seed, stop);
  if (found && found->claims.size() == problem.claims.size()) return ByInvariant(problem, std::move(*found));
  if (auto refuted = search.Run(std::min<size_t>(options.samples, 32))) return Outcome{std::move(*refuted)};
  if (!found) return DecideByTubes(problem, options, stop);
  Problem rest = problem;
  std::vector<size_t> left;  // of the claims, by their index in `rest`
  rest.claims.clear();
  for (size_t c = 0; c < problem.claims.size(); ++c) {
    if (std::ranges::find(found->claims, c) != found->claims.end()) continue;
    rest.claims.push_back(problem.claims[c]);
    left.push_back(c);
  }
  auto decided = DecideByTubes(rest, options, stop);
  if (!decided.ok()) return decided.error();
  Outcome outcome = std::move(decided).value();
  if (auto* proved = std::get_if<Proved>(&outcome)) proved->invariant = std::move(found->invariant);
  if (auto* refuted = std::get_if<Refuted>(&outcome))
    refuted->violation.claim = left[refuted->violation.claim];
  auto* open = std::get_if<Undecided>(&outcome);
  if (open != nullptr && open->closest) open->closest->claim = left[open->closest->claim];
  return outcome;
}

}  // namespace

base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop) {
  const bool switches = !problem.events.empty() || ChoosesLaws(problem);
  return switches ? DecideWithSwitches(problem, options, stop) : DecideByTubes(problem, options, stop);
}

}  // namespace rondo::reach
