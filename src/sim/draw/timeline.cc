#include "sim/draw/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/svg.h"
#include "sim/draw/history.h"

namespace rondo::sim {
namespace {

using draw::Svg;

constexpr double kMargin = 16, kAxis = 64, kHead = 30, kTitle = 22;
constexpr double kLeastLane = 130, kMostLane = 320, kBar = 16;
constexpr double kRow = 18;     // of a message or an incident
constexpr double kSecond = 22;  // of time that passes
constexpr double kLeastGap = 12, kMostGap = 150;
constexpr size_t kMostMessages = 400;
constexpr std::string_view kInk = "#333333", kPale = "#bbbbbb", kMoves = "#d5e6f5", kBad = "#cc2222";

class Timeline {
 public:
  explicit Timeline(const StageHistory& history) : h_(history) {
    end_ = h_.messages.size() > kMostMessages ? h_.messages[kMostMessages].time : h_.end;
    for (const auto& m : h_.motions) {
      const bool drawn = m.to > m.from && m.from <= end_;
      if (drawn) lane_ = std::clamp(Svg::WidthOf(m.text) + kBar + 20, lane_, kMostLane);
    }
    Rows();
  }

  std::string Draw() {
    const double bottom = At(end_).second + kMargin;
    const double width = kAxis + lane_ * static_cast<double>(h_.robots.size()) + kMargin;
    svg_.Text(kMargin, kMargin, Title(), Svg::Anchor::kStart, width - 2 * kMargin, true);
    for (size_t r = 0; r < h_.robots.size(); ++r) {
      svg_.Line(Lane(r), kTitle + kHead, Lane(r), bottom, kPale);
      svg_.Rect(Lane(r) - lane_ / 2 + 8, kTitle + 6, lane_ - 16, kHead - 10, {"#eeeeee", kInk, false, 3});
      svg_.Text(Lane(r), kTitle + 20, h_.robots[r], Svg::Anchor::kMiddle, lane_ - 24, true);
    }
    for (const auto& m : h_.motions) Motion(m);
    for (const auto& [time, first, last] : instants_) {
      svg_.Text(kAxis - 8, first + 4, fmt::format("{:.6g} s", time), Svg::Anchor::kEnd, kAxis - 12);
      svg_.Line(kAxis - 4, first, kAxis, first, kInk);
    }
    for (const auto& [y, message] : arrows_) Arrow(y, *message);
    for (const auto& [y, what] : marks_)
      svg_.Text(kAxis + 8, y + 4, what, Svg::Anchor::kStart, width - kAxis - 16, true, kBad);
    return svg_.Finish(width, bottom + kMargin, Title());
  }

 private:
  struct Instant {
    double time, first, last;  // rows
  };

  double Lane(size_t robot) const { return kAxis + lane_ * (static_cast<double>(robot) + 0.5); }

  // Places everything that happens: later things are lower, those of one instant below each other.
  void Rows() {
    std::vector<double> times{0, end_};
    for (const auto& m : h_.motions) times.insert(times.end(), {m.from, m.to});
    for (const auto& m : h_.messages) times.push_back(m.time);
    for (const auto& i : h_.incidents) times.push_back(i.time);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    double y = kTitle + kHead + 12;
    size_t message = 0, incident = 0;
    for (size_t i = 0; i < times.size() && times[i] <= end_; ++i) {
      if (i > 0) y += std::clamp((times[i] - times[i - 1]) * kSecond, kLeastGap, kMostGap);
      instants_.push_back({times[i], y, y});
      for (; incident < h_.incidents.size() && h_.incidents[incident].time <= times[i]; ++incident, y += kRow)
        marks_.emplace_back(y + kRow, h_.incidents[incident].what);
      for (; message < h_.messages.size() && h_.messages[message].time <= times[i]; ++message, y += kRow)
        arrows_.emplace_back(y + kRow, &h_.messages[message]);
      if (y > instants_.back().first) y += kRow / 2;
      instants_.back().last = y;
    }
  }

  // The first and the last row of an instant, or where one between others would be.
  std::pair<double, double> At(double time) const {
    const auto it = std::ranges::lower_bound(instants_, time, {}, &Instant::time);
    return it == instants_.end() ? std::pair(instants_.back().last, instants_.back().last)
                                 : std::pair(it->first, it->last);
  }

  void Motion(const StageHistory::Motion& m) {
    if (m.to <= m.from || m.from > end_) return;
    const double top = At(m.from).second, bottom = At(std::min(m.to, end_)).first;
    const double left = Lane(m.robot) - lane_ / 2 + 10;
    svg_.Rect(left, top, kBar, std::max(bottom - top, 2.0), {kMoves, kInk, false, 2});
    if (bottom - top >= kLeastGap - 1)
      svg_.Text(left + kBar + 5, (top + bottom) / 2 + 4, m.text, Svg::Anchor::kStart, lane_ - kBar - 22);
  }

  void Arrow(double y, const StageHistory::Message& m) {
    const double from = Lane(m.from), to = Lane(m.to);
    svg_.Arrow(from, y, to, y, kInk);
    svg_.Text((from + to) / 2, y - 4, m.label, Svg::Anchor::kMiddle, std::abs(from - to) - 12);
  }

  std::string Title() const {
    std::string title = fmt::format("{}, seed {}", TextOf(h_.run, "choreography"),
                                    h_.run.contains("seed") ? h_.run["seed"].dump() : "?");
    if (end_ < h_.end) title += fmt::format(": the first {:.6g} of {:.6g} s", end_, h_.end);
    return title;
  }

  const StageHistory& h_;
  Svg svg_;
  double lane_ = kLeastLane;
  double end_ = 0;  // of what is drawn
  std::vector<Instant> instants_;
  std::vector<std::pair<double, const StageHistory::Message*>> arrows_;
  std::vector<std::pair<double, std::string>> marks_;
};

}  // namespace

std::string DrawTimeline(const StageHistory& history) { return Timeline(history).Draw(); }

}  // namespace rondo::sim
