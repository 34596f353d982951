#include "choreo/draw/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "draw/svg.h"
#include "lang/expr_printer.h"

namespace rondo::choreo {
namespace {

using draw::Svg;

constexpr double kMargin = 16;
constexpr double kLeastLane = 120;
constexpr double kMostLane = 300;
constexpr double kRow = 30;
constexpr double kSmallRow = 20;
constexpr double kBoxInset = 16;
constexpr double kInset = 3;  // of frames that stand in frames

constexpr std::string_view kInk = "#333333";
constexpr std::string_view kPale = "#bbbbbb";
constexpr std::string_view kRigid = "#f3c9a8";
constexpr std::string_view kFree = "#d5e6f5";

class Chart {
 public:
  Chart(const Graph& graph, const lang::ExprPool& pool) : graph_(graph), pool_(pool) {}

  std::string Run() {
    lane_ = kLeastLane;
    for (const Instance& i : graph_.instances)
      lane_ = std::max(lane_, Svg::WidthOf(i.text) + 2 * kBoxInset + 4);
    lane_ = std::min(lane_, kMostLane);
    at_.assign(graph_.robots.size(), kMargin + kRow + 10);
    FindLoops();
    std::vector<NodeId> todo{graph_.start};
    while (!todo.empty()) {
      const NodeId next = todo.back();
      todo.pop_back();
      if (const NodeId stop = Draw(next, {}, 0); stop.valid()) todo.push_back(stop);
    }
    const double bottom = (at_.empty() ? 0 : *std::ranges::max_element(at_)) + kMargin;
    for (size_t r = 0; r < graph_.robots.size(); ++r) {
      const double x = Centre(r);
      svg_.Rect(x - lane_ / 2 + 8, kMargin, lane_ - 16, kRow - 8, {"#eeeeee", kInk, false, 3});
      svg_.Text(x, kMargin + 15, graph_.robots[r].text, Svg::Anchor::kMiddle, lane_ - 20, true);
    }
    return svg_.Finish(2 * kMargin + lane_ * static_cast<double>(graph_.robots.size()), bottom,
                       graph_.source->name.text);
  }

 private:
  double Centre(size_t robot) const { return kMargin + lane_ * (static_cast<double>(robot) + 0.5); }
  double Left(const Scope& scope, int depth) const {
    return Centre(scope.empty() ? 0 : scope.begin()->index()) - lane_ / 2 + kInset * (depth + 1);
  }
  double Right(const Scope& scope, int depth) const {
    return Centre(scope.empty() ? 0 : scope.rbegin()->index()) + lane_ / 2 - kInset * (depth + 1);
  }

  // The next row of all lanes of a scope; draws their lifelines down to its end.
  double Take(const Scope& scope, double height) {
    double y = 0;
    for (const RobotId r : scope) y = std::max(y, at_[r.index()]);
    for (const RobotId r : scope) {
      svg_.Line(Centre(r.index()), at_[r.index()], Centre(r.index()), y + height, kPale);
      at_[r.index()] = y + height;
    }
    return y;
  }

  // Merges to which some way leads back.
  void FindLoops() {
    enum class Mark : uint8_t { kNew, kOpen, kDone };
    std::vector<Mark> marks(graph_.nodes.size(), Mark::kNew);
    std::vector<std::pair<NodeId, size_t>> path{{graph_.start, 0}};
    marks[graph_.start.index()] = Mark::kOpen;
    while (!path.empty()) {
      auto& [id, child] = path.back();
      const Node& n = graph_[id];
      if (child >= n.next.size()) {
        marks[id.index()] = Mark::kDone;
        path.pop_back();
        continue;
      }
      const NodeId next = n.next[child++];
      if (marks[next.index()] == Mark::kOpen) loops_.insert(next);
      if (marks[next.index()] != Mark::kNew) continue;
      marks[next.index()] = Mark::kOpen;
      path.emplace_back(next, 0);
    }
  }

  // Draws from a node up to one where alternatives meet, or `join`; returns it, or nothing if the way ends.
  NodeId Draw(NodeId id, NodeId join, int depth) {
    bool first = true;
    while (id != join) {
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kMerge && !loops_.contains(id) && !first) return id;
      first = false;
      if (n.kind != NodeKind::kMerge && n.kind != NodeKind::kEnd && !drawn_.insert(id).second) return {};
      switch (n.kind) {
        case NodeKind::kMessage:
          Message(n);
          break;
        case NodeKind::kMotion:
          Motion(n);
          break;
        case NodeKind::kMerge:
          if (loops_.contains(id) && !Loop(id, n)) return {};
          break;
        case NodeKind::kChoice: {
          const NodeId stop = Choice(n, join, depth);
          if (!stop.valid()) return {};
          id = stop;
          first = true;
          continue;
        }
        case NodeKind::kFork:
          Fork(n, depth);
          id = n.join;
          if (id == join) return id;
          break;
        case NodeKind::kJoin:
          break;
        case NodeKind::kEnd: {
          const double y = Take(n.scope, kSmallRow / 2);
          svg_.Line(Left(n.scope, depth), y + 6, Right(n.scope, depth), y + 6, kInk);
          return {};
        }
      }
      id = graph_[id].next[0];
    }
    return id;
  }

  void Message(const Node& n) {
    const double y = Take(n.scope, kRow) + kRow / 2 + 4;
    const double from = Centre(n.from.index()), to = Centre(n.to.index());
    svg_.Arrow(from, y, to, y, kInk);
    std::string text = n.label;
    std::string payload;
    for (size_t i = 0; i < n.names.size(); ++i)
      payload += (i > 0 ? ", " : "") + (n.names[i].empty() ? "…" : n.names[i]);
    if (!payload.empty()) text += "(" + payload + ")";
    svg_.Text((from + to) / 2, y - 4, text, Svg::Anchor::kMiddle,
              std::max(std::abs(to - from) - 10, lane_ - 10));
  }

  void Motion(const Node& n) {
    const double y = Take(n.scope, kRow);
    for (const Part& p : n.parts) {
      const double x = Centre(p.robot.index());
      svg_.Rect(x - lane_ / 2 + kBoxInset, y + 4, lane_ - 2 * kBoxInset, kRow - 8,
                {p.duration.interruptible ? kFree : kRigid, kInk, false, 4});
      svg_.Text(x, y + kRow / 2 + 4, graph_.instances[p.instance].text, Svg::Anchor::kMiddle,
                lane_ - 2 * kBoxInset - 4);
    }
  }

  // Where a loop begins, or goes back to its beginning: false.
  bool Loop(NodeId id, const Node& n) {
    const auto [it, fresh] = numbers_.emplace(id, numbers_.size() + 1);
    const double y = Take(n.scope, kSmallRow);
    const std::string mark =
        fresh ? fmt::format("{}:", it->second) : fmt::format("again from {}", it->second);
    const double x = Left(n.scope, 0);
    svg_.Rect(x, y + 2, Svg::WidthOf(mark) + 8, kSmallRow - 4, {"#fff6c8", kInk, false, 2});
    svg_.Text(x + 4, y + 14, mark, Svg::Anchor::kStart, 200);
    return fresh;
  }

  NodeId Choice(const Node& n, NodeId join, int depth) {
    const double top = Take(n.scope, 4);
    const double left = Left(n.scope, depth), right = Right(n.scope, depth);
    std::vector<NodeId> stops;
    for (size_t b = 0; b < n.next.size(); ++b) {
      const double y = Take(n.scope, kSmallRow);
      if (b > 0) svg_.Line(left, y, right, y, kInk, true);
      const std::string guard = n.guards[b].valid() ? lang::PrintExpr(pool_, n.guards[b]) : "otherwise";
      svg_.Text(left + 6, y + 14, fmt::format("{}: {}", graph_.NameOf(n.chooser), guard), Svg::Anchor::kStart,
                right - left - 12, true);
      const NodeId stop = Draw(n.next[b], join, depth + 1);
      if (stop.valid() && std::ranges::find(stops, stop) == stops.end()) stops.push_back(stop);
    }
    const double bottom = Take(n.scope, 6);
    svg_.Rect(left, top + 2, right - left, bottom - top, {"none", kInk, false, 3});
    // Where several alternatives meet in different places, the rest follows one after the other.
    NodeId last;
    for (const NodeId stop : stops) {
      if (last.valid() && last != join) Draw(last, join, depth);
      last = stop;
    }
    return last;
  }

  void Fork(const Node& n, int depth) {
    const double top = Take(n.scope, 8);
    double bottom = top;
    for (size_t b = 0; b < n.next.size(); ++b) {
      Draw(n.next[b], n.join, depth + 1);
      for (const RobotId r : n.threads[b]) bottom = std::max(bottom, at_[r.index()]);
    }
    for (size_t b = 0; b < n.next.size(); ++b) {
      if (n.threads[b].empty()) continue;
      Take(n.threads[b], 0);
      for (const RobotId r : n.threads[b]) {
        svg_.Line(Centre(r.index()), at_[r.index()], Centre(r.index()), bottom + 8, kPale);
        at_[r.index()] = bottom + 8;
        const double x = Centre(r.index());
        svg_.Rect(x - lane_ / 2 + kInset * (depth + 1), top + 4, lane_ - 2 * kInset * (depth + 1),
                  bottom - top, {"none", kColours[b % kColours.size()], true, 3});
      }
    }
  }

  static constexpr std::array<std::string_view, 6> kColours = {"#c0392b", "#2471a3", "#1e8449",
                                                               "#7d3c98", "#b9770e", "#117864"};

  const Graph& graph_;
  const lang::ExprPool& pool_;
  Svg svg_;
  double lane_ = kLeastLane;
  std::vector<double> at_;  // how far each lane is drawn
  std::set<NodeId> loops_;
  std::set<NodeId> drawn_;
  std::map<NodeId, size_t> numbers_;
};

}  // namespace

std::string DrawChart(const Graph& graph, const lang::ExprPool& pool) { return Chart(graph, pool).Run(); }

}  // namespace rondo::choreo
