#include "reach/draw/tube.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "draw/svg.h"
#include "reach/problem/bounds.h"

namespace rondo::reach {

namespace {

using draw::Svg;

constexpr double kWidth = 300, kHeight = 170, kGap = 64, kTop = 46;
constexpr size_t kColumns = 3, kMostPanels = 12, kMostBoxes = 400;
constexpr const char* kTube = "#9dc3e6";
constexpr const char* kTrajectory = "#1f4e79";
constexpr const char* kStart = "#2ca02c";
constexpr const char* kBound = "#d62728";

struct Row {
  double time;
  std::vector<double> state;
};
using Trajectory = std::vector<Row>;

// A bound that a claim puts on one state, for a while.
struct Bound {
  size_t state;
  double value, from, to;
};

// A rectangle of values on a rectangle of pixels, with axes.
class Panel {
 public:
  Panel(Svg& svg, double left, double top, Interval x, Interval y)
      : svg_(svg), left_(left), top_(top), x_(Widened(x, 0)), y_(Widened(y, 0.05)) {}

  double X(double x) const { return left_ + (x - x_.lo) / (x_.hi - x_.lo) * kWidth; }
  double Y(double y) const { return top_ + kHeight - (y - y_.lo) / (y_.hi - y_.lo) * kHeight; }
  void Box(Interval x, Interval y, std::string_view fill, std::string_view stroke = "none") {
    const double width = std::max(1.0, X(x.hi) - X(x.lo));
    const double height = std::max(1.0, Y(y.lo) - Y(y.hi));
    svg_.Rect(X(x.lo), Y(y.hi), width, height, {fill, stroke});
  }
  void Axes(const std::string& title, const std::string& below) {
    svg_.Rect(left_, top_, kWidth, kHeight, {"none", "#888888"});
    svg_.Text(left_ + kWidth / 2, top_ - 6, title, Svg::Anchor::kMiddle, kWidth, true);
    svg_.Text(left_, top_ + kHeight + 13, fmt::format("{:.4g}", x_.lo), Svg::Anchor::kStart, kGap);
    svg_.Text(left_ + kWidth, top_ + kHeight + 13, fmt::format("{:.4g}", x_.hi), Svg::Anchor::kEnd, kGap);
    svg_.Text(left_ + kWidth / 2, top_ + kHeight + 13, below, Svg::Anchor::kMiddle, kWidth / 2);
    svg_.Text(left_ - 4, top_ + kHeight, fmt::format("{:.4g}", y_.lo), Svg::Anchor::kEnd, kGap - 6);
    svg_.Text(left_ - 4, top_ + 9, fmt::format("{:.4g}", y_.hi), Svg::Anchor::kEnd, kGap - 6);
  }
  bool ShowsY(double y) const { return y_.Contains(y); }
  Interval x() const { return x_; }

 private:
  static Interval Widened(Interval i, double share) {
    const double more = share * i.Width() + (i.Width() > 0 ? 0 : 1e-3 + 1e-3 * std::fabs(i.lo));
    return {i.lo - more, i.hi + more};
  }
  Svg& svg_;
  double left_, top_;
  Interval x_, y_;
};

class Picture {
 public:
  Picture(const Problem& problem, const Outcome& outcome, const TubePicture& options,
          const base::StopToken& stop)
      : p_(problem), options_(options), stop_(stop) {
    if (const auto* proved = std::get_if<Proved>(&outcome)) leaves_ = &proved->leaves;
    if (const auto* open = std::get_if<Undecided>(&outcome)) leaves_ = &open->leaves;
    refuted_ = std::get_if<Refuted>(&outcome);
  }

  base::Result<std::string> Run() {
    auto made = Trajectories::Of(p_);
    if (!made.ok()) return made.error();
    Trajectories trajectories = std::move(made).value();
    Simulate(trajectories);
    FindBounds();
    std::vector<size_t> shown = Shown();
    const std::optional<std::pair<size_t, size_t>> plane = Plane();
    const size_t panels = std::min(kMostPanels, shown.size() + (plane ? 1 : 0));
    size_t at = 0;
    if (plane) DrawPlane(at++, plane->first, plane->second);
    for (size_t k = 0; at < panels; ++k) DrawState(at++, shown[k]);
    const size_t columns = std::min(kColumns, std::max<size_t>(1, panels));
    const size_t rows = (panels + kColumns - 1) / kColumns;
    const double width = kGap + static_cast<double>(columns) * (kWidth + kGap);
    Legend(shown.size() + (plane ? 1 : 0) - panels);
    return svg_.Finish(std::max(width, 560.0), kTop + static_cast<double>(rows) * (kHeight + kGap), p_.name);
  }

 private:
  double Horizon() const { return p_.horizon.ToDouble(); }

  void Simulate(Trajectories& trajectories) {
    std::mt19937_64 random(options_.seed);
    const size_t n = p_.states.size();
    for (size_t k = 0; k < options_.samples && !stop_.StopRequested(); ++k) {
      Execution execution;
      for (size_t i = 0; i < n; ++i) {
        const double u = static_cast<double>(random() >> 11) * 0x1p-53;
        const Interval side = p_.initial[i];
        const double share = k < options_.samples / 2 ? std::round(u) : u;
        execution.start.push_back(std::clamp(side.lo + share * (side.hi - side.lo), side.lo, side.hi));
      }
      for (size_t i = 0; i < p_.copy_of.size(); ++i) {
        if (p_.copy_of[i]) execution.start[i] = execution.start[*p_.copy_of[i]];
      }
      if (!p_.inputs.empty()) {
        execution.input_period = Horizon() / 16;
        for (int slot = 0; slot < 16; ++slot) {
          std::vector<double> values;
          for (const Input& input : p_.inputs) {
            const double u = static_cast<double>(random() >> 11) * 0x1p-53;
            values.push_back(input.bounds.lo + u * (input.bounds.hi - input.bounds.lo));
          }
          execution.inputs.push_back(std::move(values));
        }
      }
      if (trajectories.MissAssumed(execution.start) > 1e-9) continue;
      samples_.push_back(Along(trajectories, execution, Horizon()));
    }
    if (refuted_ != nullptr) broken_ = Along(trajectories, refuted_->execution, refuted_->violation.time);
  }

  Trajectory Along(Trajectories& trajectories, const Execution& execution, double end) const {
    Trajectory rows;
    trajectories.Run(
        execution, Horizon() / 400,
        [&](double t, std::span<const double> x) {
          rows.push_back({t, {x.begin(), x.end()}});
          return t < end && !stop_.StopRequested();
        },
        1e-8);
    return rows;
  }

  // Bounds on single states that follow from claims.
  void FindBounds() {
    for (const Claim& claim : p_.claims) {
      auto formula = Normalise(*p_.arena, claim.formula);
      if (!formula.ok()) continue;
      std::vector<TermId> variables = p_.states;
      for (const Input& i : p_.inputs) variables.push_back(i.term);
      auto terms = Compile(*p_.arena, variables, formula.value().terms);
      if (!terms.ok()) continue;
      interval::Box box(variables.size());
      Contract(*p_.arena, terms.value(), formula.value(), box);
      for (size_t i = 0; i < p_.states.size(); ++i) {
        for (const double value : {box[i].lo, box[i].hi}) {
          if (std::isfinite(value)) bounds_.push_back({i, value, claim.from.ToDouble(), claim.to.ToDouble()});
        }
      }
    }
  }

  std::vector<size_t> Shown() const {
    std::vector<size_t> shown;
    const TermId zero = p_.arena->Number(p_.arena->Real(), Rational(0));
    for (size_t i = 0; i < p_.states.size(); ++i) {
      bool changes = p_.rates[i] != zero || (p_.controller && p_.controller->updates[i]);
      for (const Event& e : p_.events) changes = changes || e.updates[i];
      if (changes && options_.names[i] != "clock") shown.push_back(i);
    }
    return shown;
  }

  std::optional<std::pair<size_t, size_t>> Plane() const {
    const auto x = std::ranges::find(options_.names, "x");
    const auto y = std::ranges::find(options_.names, "y");
    if (x == options_.names.end() || y == options_.names.end()) return std::nullopt;
    return std::pair{static_cast<size_t>(x - options_.names.begin()),
                     static_cast<size_t>(y - options_.names.begin())};
  }

  // All that is drawn of a state.
  Interval Extent(size_t i) const {
    Interval all = p_.initial[i];
    for (const Leaf& leaf : leaves_ != nullptr ? *leaves_ : std::vector<Leaf>{}) {
      for (const TubeSegment& s : leaf.tube) all = interval::Hull(all, s.during[i]);
    }
    for (const Trajectory& t : samples_) {
      for (const Row& row : t) all = interval::Hull(all, Interval::Point(row.state[i]));
    }
    for (const Row& row : broken_) all = interval::Hull(all, Interval::Point(row.state[i]));
    // Bounds that are near.
    const Interval drawn = all;
    for (const Bound& b : bounds_) {
      if (b.state == i && b.value > drawn.lo - drawn.Width() && b.value < drawn.hi + drawn.Width())
        all = interval::Hull(all, Interval::Point(b.value));
    }
    return all;
  }

  Panel At(size_t number, Interval x, Interval y) {
    const size_t line = number / kColumns;
    const auto column = static_cast<double>(number % kColumns);
    const auto row = static_cast<double>(line);
    return {svg_, kGap + column * (kWidth + kGap), kTop + row * (kHeight + kGap) + 16, x, y};
  }

  void DrawState(size_t number, size_t i) {
    Panel panel = At(number, {0, Horizon()}, Extent(i));
    // The hull of all parts, column by column.
    std::vector<Interval> columns(static_cast<size_t>(kWidth), Interval::Empty());
    for (const Leaf& leaf : leaves_ != nullptr ? *leaves_ : std::vector<Leaf>{}) {
      for (const TubeSegment& s : leaf.tube) {
        const auto column = [&](double t) {
          return std::min(columns.size() - 1, static_cast<size_t>(std::max(0.0, t / Horizon() * kWidth)));
        };
        for (size_t c = column(s.from); c <= column(s.to); ++c)
          columns[c] = interval::Hull(columns[c], s.during[i]);
      }
    }
    const double step = Horizon() / kWidth;
    for (size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].IsEmpty()) continue;
      const double t = static_cast<double>(c) * step;
      panel.Box({t, t + step}, columns[c], kTube);
    }
    const auto line = [&](const Trajectory& rows) {
      std::vector<std::array<double, 2>> points;
      for (const Row& row : rows) points.push_back({panel.X(row.time), panel.Y(row.state[i])});
      return points;
    };
    for (const Trajectory& t : samples_) svg_.Polyline(line(t), kTrajectory, 0.7, 0.6);
    panel.Box({0, Horizon() / 100}, p_.initial[i], kStart);
    for (const Bound& b : bounds_) {
      if (b.state != i || !panel.ShowsY(b.value)) continue;
      const double right = panel.X(b.to);
      svg_.Line(std::min(panel.X(b.from), right - 8), panel.Y(b.value), right, panel.Y(b.value), kBound,
                true);
    }
    svg_.Polyline(line(broken_), kBound, 1.5);
    if (!broken_.empty()) Mark(panel.X(broken_.back().time), panel.Y(broken_.back().state[i]));
    panel.Axes(options_.names[i], "time, s");
  }

  void DrawPlane(size_t number, size_t x, size_t y) {
    Panel panel = At(number, Extent(x), Extent(y));
    for (const Leaf& leaf : leaves_ != nullptr ? *leaves_ : std::vector<Leaf>{}) {
      const size_t stride = leaf.tube.size() / kMostBoxes + 1;
      for (size_t s = 0; s < leaf.tube.size(); s += stride) {
        Interval across = leaf.tube[s].during[x];
        Interval along = leaf.tube[s].during[y];
        for (size_t k = s; k < std::min(s + stride, leaf.tube.size()); ++k) {
          across = interval::Hull(across, leaf.tube[k].during[x]);
          along = interval::Hull(along, leaf.tube[k].during[y]);
        }
        panel.Box(across, along, kTube);
      }
    }
    const auto line = [&](const Trajectory& rows) {
      std::vector<std::array<double, 2>> points;
      for (const Row& row : rows) points.push_back({panel.X(row.state[x]), panel.Y(row.state[y])});
      return points;
    };
    for (const Trajectory& t : samples_) svg_.Polyline(line(t), kTrajectory, 0.7, 0.6);
    panel.Box(p_.initial[x], p_.initial[y], "none", kStart);
    svg_.Polyline(line(broken_), kBound, 1.5);
    if (!broken_.empty()) Mark(panel.X(broken_.back().state[x]), panel.Y(broken_.back().state[y]));
    panel.Axes(options_.names[y] + " over " + options_.names[x], options_.names[x]);
  }

  void Mark(double x, double y) {
    svg_.Line(x - 4, y - 4, x + 4, y + 4, kBound);
    svg_.Line(x - 4, y + 4, x + 4, y - 4, kBound);
  }

  void Legend(size_t left_out) {
    std::string text = leaves_ != nullptr && !leaves_->empty() ? "blue: enclosed; " : "";
    text += "lines: simulated; green: start; dashed: bounds of claims";
    if (refuted_ != nullptr)
      text += fmt::format("; red: `{}` fails after {:.4g} s", p_.claims[refuted_->violation.claim].name,
                          refuted_->violation.time);
    if (left_out > 0) text += fmt::format("; {} states are not shown", left_out);
    svg_.Text(kGap, 18, p_.name, Svg::Anchor::kStart, 900, true);
    svg_.Text(kGap, 34, text, Svg::Anchor::kStart, 900);
  }

  const Problem& p_;
  const TubePicture& options_;
  const base::StopToken& stop_;
  const std::vector<Leaf>* leaves_ = nullptr;
  const Refuted* refuted_ = nullptr;
  std::vector<Trajectory> samples_;
  Trajectory broken_;
  std::vector<Bound> bounds_;
  Svg svg_;
};

}  // namespace

base::Result<std::string> DrawTube(const Problem& problem, const Outcome& outcome, const TubePicture& picture,
                                   const base::StopToken& stop) {
  return Picture(problem, outcome, picture, stop).Run();
}

}  // namespace rondo::reach
