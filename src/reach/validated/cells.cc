#include "reach/validated/cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "reach/invariants/candidates.h"
#include "reach/problem/bounds.h"
#include "reach/validated/runner.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

constexpr size_t kMostCells = 20'000;
constexpr double kThin =
    1e-6;  // of a cell: a start that is thinner, such as a rounded number, stands in the middle of one
constexpr double kMargin = 0.02;  // of a cell, by which images are widened: the checker may be a little wider
// How many cells make up what samples visit, by how many states the grid divides, coarse grids first.
const std::vector<std::vector<size_t>> kGrids = {{100, 400, 1600}, {40, 80, 160}, {12, 24}};

using Cell = std::vector<uint32_t>;

class Exploration {
 public:
  Exploration(const Problem& problem, Trajectories& trajectories, const ProverOptions& options,
              const base::StopToken& stop)
      : problem_(problem), trajectories_(trajectories), options_(options), stop_(stop) {
    options_.wide = true;
    options_.flow.first_step = problem.controller->period.ToDouble();
  }

  std::optional<Proved> Run() {
    if (!Prepare() || live_.empty() || live_.size() > kGrids.size()) return std::nullopt;
    auto stages = Stages::Of(period_);
    if (!stages.ok()) return std::nullopt;
    for (const size_t cells : kGrids[live_.size() - 1]) {
      if (!MakeGrid(cells)) return std::nullopt;
      if (Explore(*stages.value()) && FinallyHolds()) return Result();
      if (stop_.StopRequested()) break;
    }
    return std::nullopt;
  }

 private:
  // What becomes of a cell in one period.
  struct Image {
    bool proved = false;
    interval::Box end;
    interval::Box during;
    std::vector<size_t> cells;  ///< that the end meets
  };

  // Which states the grid divides, and the problem of one period. False if this is no problem for a grid.
  bool Prepare() {
    auto made = Stages::Of(problem_);
    if (!made.ok()) return false;
    all_ = std::move(made).value();
    const auto stage = all_->For({all_->modes().start()});
    if (!stage.ok()) return false;
    stage_ = stage.value();
    const Program& updates = stage_->updates;
    const TermId zero = problem_.arena->Number(problem_.arena->Real(), Rational(0));
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      const bool constant = problem_.rates[i] == zero && !problem_.controller->updates[i];
      const bool read = std::ranges::any_of(updates.outputs, [&](uint32_t output) {
        return std::ranges::find(updates.depends[output], i) != updates.depends[output].end();
      });
      read_.push_back(read);
      if (read && !constant) live_.push_back(i);
    }
    period_ = problem_;
    period_.horizon = problem_.controller->period;
    period_.assume = problem_.arena->True();
    period_.copy_of.clear();
    period_.pinned.clear();
    period_.claims.clear();
    for (const Claim& claim : problem_.claims) {
      const bool finally = claim.from == problem_.horizon && claim.to == problem_.horizon;
      if (finally) {
        finally_ = true;
      } else if (claim.from == Rational(0) && claim.to == problem_.horizon) {
        period_.claims.push_back({claim.name, claim.formula, Rational(0), period_.horizon});
      } else {
        return false;
      }
    }
    const Rational periods = problem_.horizon / period_.horizon;
    return !finally_ || periods.Floor() == periods;
  }

  // Edges on both ends of where states begin, so that these make up whole cells.
  bool MakeGrid(size_t count) {
    const auto visited = invariants::Visited(problem_, all_->modes(), {all_->modes().start()}, trajectories_,
                                             options_.seed, stop_)[0];
    if (visited.empty()) return false;
    paving_ = {.states = live_, .edges = {}, .cells = {}};
    for (const size_t i : live_) {
      const Interval start = problem_.initial[i];
      const Interval hull = interval::Hull(start, visited[i]);
      if (!std::isfinite(hull.Width()) || !(hull.Width() > 0)) return false;
      double width = hull.Width() / static_cast<double>(count);
      const double parts = start.Width() < kThin * width ? 0 : std::ceil(start.Width() / width);
      if (parts > 0) width = start.Width() / parts;
      const double first = parts > 0 ? start.lo : start.Middle() - width / 2;
      const double before = std::ceil((first - hull.lo + hull.Width() / 2) / width);
      const double after = std::ceil((hull.hi + hull.Width() / 2 - first) / width);
      if (!(before + after < static_cast<double>(kMostCells))) return false;
      std::vector<double>& edges = paving_.edges.emplace_back();
      for (double k = -before; k <= after; ++k)
        edges.push_back(k == parts && parts > 0 ? start.hi : first + k * width);
      if (!std::ranges::is_sorted(edges)) return false;
    }
    return true;
  }

  // The states of a cell: those that the grid does not divide are what they always are, or do not matter.
  interval::Box BoxOf(const Cell& cell) const {
    interval::Box box = problem_.initial;
    for (size_t i = 0; i < box.size(); ++i) {
      if (!read_[i]) box[i] = Interval::Point(0);
    }
    for (size_t k = 0; k < live_.size(); ++k)
      box[live_[k]] = {paving_.edges[k][cell[k]], paving_.edges[k][cell[k] + 1]};
    return box;
  }

  // All cells that make up these sides. False if the grid is not wide enough, or they are too many.
  bool CellsOf(const interval::Box& sides, const std::function<void(const Cell&)>& visit) const {
    Cell first, last;
    double count = 1;
    for (size_t k = 0; k < live_.size(); ++k) {
      const std::vector<double>& edges = paving_.edges[k];
      const auto low = std::ranges::upper_bound(edges, sides[k].lo) - edges.begin() - 1;
      const auto high = std::ranges::lower_bound(edges, sides[k].hi) - edges.begin() - 1;
      if (low < 0 || high >= static_cast<ptrdiff_t>(edges.size()) - 1) return false;
      first.push_back(static_cast<uint32_t>(low));
      last.push_back(static_cast<uint32_t>(std::max(low, high)));
      count *= static_cast<double>(last.back() - first.back() + 1);
    }
    if (count > static_cast<double>(kMostCells)) return false;
    Cell at = first;
    while (true) {
      visit(at);
      size_t k = 0;
      for (; k < at.size() && at[k] == last[k]; ++k) at[k] = first[k];
      if (k == at.size()) return true;
      ++at[k];
    }
  }

  size_t Add(const Cell& cell) {
    const auto [it, fresh] = index_.emplace(cell, paving_.cells.size());
    if (fresh) paving_.cells.push_back(cell);
    return it->second;
  }

  // Every cell that is reached, and where it leads. False if a claim is not shown in one of them.
  bool Explore(Stages& stages) {
    index_.clear();
    images_.clear();
    interval::Box sides;
    for (const size_t i : live_) sides.push_back(problem_.initial[i]);
    const bool inside = CellsOf(sides, [&](const Cell& cell) {
      interval::Box box = problem_.initial;
      const interval::Box own = BoxOf(cell);
      for (const size_t i : live_) box[i] = own[i];
      if (CheckBox(all_->assumed_terms(), all_->assumed(), box) != verdict::Truth::kFalse) Add(cell);
    });
    if (!inside) return false;
    starts_ = paving_.cells.size();
    while (images_.size() < paving_.cells.size()) {
      if (stop_.StopRequested() || paving_.cells.size() > kMostCells) return false;
      const size_t from = images_.size();
      images_.resize(paving_.cells.size());
      base::ParallelFor(images_.size() - from, options_.jobs, [&](size_t k) {
        images_[from + k] = Follow(stages, BoxOf(paving_.cells[from + k]));
      });
      for (size_t k = from; k < images_.size(); ++k) {
        if (!images_[k].proved || !Enter(images_[k])) return false;
      }
      if (options_.progress) options_.progress(from, paving_.cells.size() - from);
    }
    return true;
  }

  Image Follow(Stages& stages, const interval::Box& box) const {
    Attempt attempt = Runner(stages, options_, options_.flow, box, box, stop_).Run();
    Image image{.proved = attempt.proved, .end = std::move(attempt.leaf.final), .during = {}, .cells = {}};
    for (const TubeSegment& s : attempt.leaf.tube) {
      if (image.during.empty()) image.during = s.during;
      for (size_t i = 0; i < s.during.size(); ++i)
        image.during[i] = interval::Hull(image.during[i], s.during[i]);
    }
    return image;
  }

  bool Enter(Image& image) {
    interval::Box sides;
    for (size_t k = 0; k < live_.size(); ++k) {
      const double more = kMargin * (paving_.edges[k][1] - paving_.edges[k][0]);
      const Interval end = image.end[live_[k]];
      sides.push_back({end.lo - more, end.hi + more});
    }
    return CellsOf(sides, [&](const Cell& cell) { image.cells.push_back(Add(cell)); });
  }

  // Claims about the horizon: in all cells that can be reached by then.
  bool FinallyHolds() const {
    if (!finally_) return true;
    std::vector<bool> now(images_.size(), false);
    std::fill_n(now.begin(), starts_, true);
    for (size_t period = 1; period < all_->samples(); ++period) {
      std::vector<bool> next(images_.size(), false);
      for (size_t k = 0; k < images_.size(); ++k) {
        if (!now[k]) continue;
        for (const size_t cell : images_[k].cells) next[cell] = true;
      }
      if (next == now) break;
      now = std::move(next);
    }
    for (size_t k = 0; k < images_.size(); ++k) {
      if (now[k] && !HoldsAtTheEnd(images_[k].end)) return false;
    }
    return true;
  }
  bool HoldsAtTheEnd(interval::Box box) const {
    for (const Input& input : problem_.inputs) box.push_back(input.bounds);
    const std::vector<Interval> values = ValuesOn(stage_->observed, box);
    return std::ranges::all_of(stage_->claims, [&](const StageClaim& claim) {
      return !claim.instant || claim.formula.Check([&](size_t atom) {
        return values[stage_->observed.outputs[claim.first + atom]];
      }) == verdict::Truth::kTrue;
    });
  }

  Proved Result() {
    Leaf leaf{.initial = problem_.initial, .path = {}, .tube = {}, .final = images_[0].during, .steps = {}};
    for (const Image& image : images_) {
      for (size_t i = 0; i < leaf.final.size(); ++i)
        leaf.final[i] = interval::Hull(leaf.final[i], interval::Hull(image.during[i], image.end[i]));
    }
    leaf.tube.push_back({0, Enclose(problem_.horizon).hi, leaf.final});
    Proved proved;
    proved.paving = std::move(paving_);
    proved.leaves.push_back(std::move(leaf));
    return proved;
  }

  const Problem& problem_;
  Trajectories& trajectories_;
  ProverOptions options_;
  const base::StopToken& stop_;
  std::unique_ptr<Stages> all_;  ///< of the whole problem
  std::shared_ptr<const Stage> stage_;
  std::vector<bool> read_;    ///< by state: whether the controller keeps it or reads it
  std::vector<size_t> live_;  ///< states that the grid divides
  Problem period_;
  bool finally_ = false;  ///< whether a claim is about the horizon
  Paving paving_;
  std::map<Cell, size_t> index_;
  std::vector<Image> images_;  ///< by cell
  size_t starts_ = 0;          ///< how many cells, the first ones, hold all starts
};

}  // namespace

bool ChoosesLaws(const Problem& problem) {
  if (!problem.controller) return false;
  std::vector<TermId> variables = problem.states;
  for (const Input& input : problem.inputs) variables.push_back(input.term);
  const auto updates = Compile(*problem.arena, std::move(variables), Updated(problem));
  return updates.ok() && std::ranges::any_of(updates.value().code,
                                             [](const Code& code) { return code.op == CodeOp::kChoose; });
}

std::optional<Proved> ProveByCells(const Problem& problem, Trajectories& trajectories,
                                   const ProverOptions& options, const base::StopToken& stop) {
  return Exploration(problem, trajectories, options, stop).Run();
}

}  // namespace rondo::reach
