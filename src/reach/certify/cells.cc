#include "reach/certify/cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "expr/substitute.h"
#include "reach/certify/follower.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

using verdict::Truth;

constexpr size_t kDegree = 2;
constexpr size_t kMostSplits = 4;

class Checking {
 public:
  Checking(const Problem& problem, const Paving& paving, const base::StopToken& stop)
      : problem_(problem), paving_(paving), stop_(stop) {}

  base::Result<size_t> Run(unsigned jobs) {
    if (std::string wrong = CheckForm(); !wrong.empty()) return base::Error{wrong};
    if (std::string wrong = MakePeriod(); !wrong.empty()) return base::Error{wrong};
    auto system = System::Of(period_);
    if (!system.ok()) return system.error();
    if (std::string wrong = FindStarts(); !wrong.empty()) return base::Error{wrong};
    ends_.resize(paving_.cells.size());
    std::vector<std::string> reasons(ends_.size());
    std::vector<size_t> steps(ends_.size());
    Bases bases;
    base::ParallelFor(ends_.size(), jobs, [&](size_t k) {
      reasons[k] = Follow(*system.value(), bases, StatesOf(paving_.cells[k]), 0, ends_[k], steps[k]);
    });
    size_t total = 0;
    for (size_t k = 0; k < ends_.size(); ++k) {
      if (!reasons[k].empty()) return base::Error{reasons[k]};
      total += steps[k];
      if (!FindNext(k)) return base::Error{"a cell leads out of the paving"};
    }
    if (std::string wrong = CheckEnd(); !wrong.empty()) return base::Error{wrong};
    return total;
  }

 private:
  std::string CheckForm() {
    if (!problem_.controller || !problem_.events.empty())
      return "a paving is about controllers that act at instants, and no events";
    if (paving_.edges.size() != paving_.states.size()) return "the paving has no edges for some state";
    for (const std::vector<double>& edges : paving_.edges) {
      const bool ascending = std::ranges::adjacent_find(edges, std::ranges::greater_equal{}) == edges.end();
      if (edges.size() < 2 || !ascending || !std::isfinite(edges.front()) || !std::isfinite(edges.back()))
        return "the edges of the paving do not ascend";
    }
    for (size_t k = 0; k < paving_.cells.size(); ++k) {
      const auto& cell = paving_.cells[k];
      if (cell.size() != paving_.states.size()) return "a cell of the paving has another dimension";
      for (size_t i = 0; i < cell.size(); ++i) {
        if (cell[i] + size_t{1} >= paving_.edges[i].size())
          return "a cell of the paving is no cell of its grid";
      }
      known_.emplace(cell, k);
    }
    // Other states are constants, or nothing depends on them when the controller acts.
    const TermId zero = problem_.arena->Number(problem_.arena->Real(), Rational(0));
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      if (std::ranges::find(paving_.states, i) != paving_.states.end()) continue;
      const bool constant = problem_.rates[i] == zero && !problem_.controller->updates[i];
      if (constant) {
        others_.emplace_back(i, problem_.initial[i]);
      } else if (!IsRead(i)) {
        others_.emplace_back(i, Interval::Point(0));
      } else {
        return "the paving leaves out a state that matters";
      }
    }
    return "";
  }

  // Does what the controller leaves behind depend on the state before?
  bool IsRead(size_t state) const {
    bool read = false;
    std::unordered_set<TermId> seen;
    for (const TermId value : Updated(problem_)) {
      expr::VisitPostorder(*problem_.arena, value, seen,
                           [&](TermId t) { read = read || t == problem_.states[state]; });
    }
    return read;
  }

  // The same problem for one period, from anywhere.
  std::string MakePeriod() {
    period_ = problem_;
    period_.horizon = problem_.controller->period;
    period_.assume = problem_.arena->True();
    period_.pinned.clear();
    period_.copy_of.clear();
    period_.claims.clear();
    for (const Claim& claim : problem_.claims) {
      if (claim.from == problem_.horizon) {
        const Rational periods = problem_.horizon / period_.horizon;
        if (periods.Floor() != periods) return "the horizon is no instant of the controller";
        at_end_.push_back(claim.formula);
        continue;
      }
      if (claim.from != Rational(0) || claim.to != problem_.horizon)
        return "a claim is neither about all times nor about the horizon";
      period_.claims.push_back({claim.name, claim.formula, Rational(0), period_.horizon});
    }
    return "";
  }

  interval::Box StatesOf(const std::vector<uint32_t>& cell) const {
    interval::Box box(problem_.states.size());
    for (const auto& [state, side] : others_) box[state] = side;
    for (size_t i = 0; i < cell.size(); ++i)
      box[paving_.states[i]] = {paving_.edges[i][cell[i]], paving_.edges[i][cell[i] + 1]};
    return box;
  }

  // Calls `visit` with cells of the grid that together enclose the box. False if the grid does not.
  bool Cover(const interval::Box& states,
             const std::function<bool(const std::vector<uint32_t>&)>& visit) const {
    std::vector<std::vector<uint32_t>> sides;
    for (size_t i = 0; i < paving_.states.size(); ++i) {
      const Interval side = states[paving_.states[i]];
      const std::vector<double>& edges = paving_.edges[i];
      if (!(edges.front() <= side.lo && side.hi <= edges.back())) return false;
      std::vector<uint32_t>& touched = sides.emplace_back();
      for (uint32_t k = 0; k + 1 < edges.size(); ++k) {
        const bool apart = edges[k + 1] < side.lo || side.hi < edges[k];
        // An end that is an edge belongs to the cell within.
        const bool only_edge = side.lo < side.hi && (edges[k + 1] == side.lo || edges[k] == side.hi);
        if (!apart && !only_edge) touched.push_back(k);
      }
    }
    std::vector<uint32_t> cell(sides.size());
    const std::function<bool(size_t)> all = [&](size_t i) {
      if (i == sides.size()) return visit(cell);
      return std::ranges::all_of(sides[i], [&](uint32_t k) {
        cell[i] = k;
        return all(i + 1);
      });
    };
    return all(0);
  }

  std::string FindStarts() {
    const auto assumed = Normalise(*problem_.arena, problem_.assume);
    if (!assumed.ok()) return assumed.error().message;
    const auto terms = Compile(*problem_.arena, problem_.states, assumed.value().terms);
    if (!terms.ok()) return terms.error().message;
    const bool covered = Cover(problem_.initial, [&](const std::vector<uint32_t>& cell) {
      const auto it = known_.find(cell);
      if (it != known_.end()) {
        starts_.push_back(it->second);
        return true;
      }
      interval::Box box = problem_.initial;
      for (size_t i = 0; i < cell.size(); ++i)
        box[paving_.states[i]] = {paving_.edges[i][cell[i]], paving_.edges[i][cell[i] + 1]};
      return CheckBox(terms.value(), assumed.value(), box) == Truth::kFalse;
    });
    return covered ? "" : "the paving does not hold all starts";
  }

  // One period from a box; halves of it if need be.
  std::string Follow(System& system, Bases& bases, const interval::Box& box, size_t depth, interval::Box& end,
                     size_t& steps) const {
    const std::vector<PartRecord::Step> hints{{.length = period_.horizon.ToDouble(), .degree = kDegree}};
    Follower follower(system, bases, kDegree, stop_);
    std::string reason = follower.Run(box, box, hints);
    steps += follower.steps();
    if (reason.empty()) {
      if (end.empty()) end = follower.End();
      for (size_t i = 0; i < end.size(); ++i) end[i] = interval::Hull(end[i], follower.End()[i]);
      return "";
    }
    const auto side = follower.WorstSide();
    if (depth == kMostSplits || !side || stop_.StopRequested()) return reason;
    for (const bool upper : {false, true}) {
      interval::Box half = box;
      (upper ? half[*side].lo : half[*side].hi) = box[*side].Middle();
      reason = Follow(system, bases, half, depth + 1, end, steps);
      if (!reason.empty()) return reason;
    }
    return "";
  }

  bool FindNext(size_t k) {
    std::vector<size_t>& next = next_.emplace_back();
    return Cover(ends_[k], [&](const std::vector<uint32_t>& cell) {
      const auto it = known_.find(cell);
      if (it == known_.end()) return false;
      next.push_back(it->second);
      return true;
    });
  }

  // Claims about the horizon, wherever the last period can end.
  std::string CheckEnd() const {
    if (at_end_.empty()) return "";
    std::vector<bool> now(next_.size(), false);
    for (const size_t k : starts_) now[k] = true;
    const size_t periods = Samples(problem_);
    for (size_t period = 1; period < periods; ++period) {
      std::vector<bool> then(next_.size(), false);
      for (size_t k = 0; k < next_.size(); ++k) {
        for (size_t i = 0; now[k] && i < next_[k].size(); ++i) then[next_[k][i]] = true;
      }
      if (then == now) break;  // and so for ever
      now = std::move(then);
    }
    std::vector<TermId> variables = problem_.states;
    for (const Input& input : problem_.inputs) variables.push_back(input.term);
    for (const TermId claim : at_end_) {
      const auto formula = Normalise(*problem_.arena, claim);
      if (!formula.ok()) return formula.error().message;
      const auto terms = Compile(*problem_.arena, variables, formula.value().terms);
      if (!terms.ok()) return terms.error().message;
      for (size_t k = 0; k < now.size(); ++k) {
        if (!now[k]) continue;
        interval::Box box = ends_[k];
        for (const Input& input : problem_.inputs) box.push_back(input.bounds);
        if (CheckBox(terms.value(), formula.value(), box) != Truth::kTrue)
          return "a claim about the horizon is not shown";
      }
    }
    return "";
  }

  const Problem& problem_;
  const Paving& paving_;
  const base::StopToken& stop_;
  Problem period_;
  std::vector<TermId> at_end_;                       ///< claims about the horizon
  std::vector<std::pair<size_t, Interval>> others_;  ///< states that the grid does not divide
  std::map<std::vector<uint32_t>, size_t> known_;    ///< the cells
  std::vector<size_t> starts_;
  std::vector<interval::Box> ends_;        ///< by cell
  std::vector<std::vector<size_t>> next_;  ///< by cell
};

}  // namespace

base::Result<size_t> CheckPaving(const Problem& problem, const Paving& paving, unsigned jobs,
                                 const base::StopToken& stop) {
  return Checking(problem, paving, stop).Run(jobs);
}

}  // namespace rondo::reach::certify
