#include "choreo/draw/automaton.h"

#include <fmt/format.h>

#include <algorithm>

#include "draw/svg.h"
#include "lang/expr_printer.h"

namespace rondo::choreo {
namespace {

using draw::Svg;

constexpr double kMargin = 20;
constexpr double kWidth = 44;
constexpr double kHeight = 24;
constexpr double kStep = 20;  // for each transition of a state
constexpr double kGap = 26;
constexpr double kBow = 110;  // how far arrows bend out, at most

struct Edge {
  std::string text;
  StateId to;
};

// Chains stay together: the first way of each state is followed to its end before the next one.
std::vector<size_t> RowsOf(const std::vector<std::vector<Edge>>& edges) {
  std::vector<size_t> row(edges.size(), edges.size());
  std::vector<size_t> todo{0};
  size_t rows = 0;
  while (!todo.empty()) {
    const size_t s = todo.back();
    todo.pop_back();
    if (row[s] < edges.size()) continue;
    row[s] = rows++;
    for (size_t e = edges[s].size(); e-- > 0;) todo.push_back(edges[s][e].to.index());
  }
  return row;
}

/// The geometry of one automaton.
class Drawing {
 public:
  Drawing(const Graph& graph, const lang::ExprPool& pool, const LocalType& type)
      : graph_(graph), type_(type) {
    edges_.resize(type.states.size());
    for (size_t s = 0; s < type.states.size(); ++s) {
      for (const auto& [action, to] : type.states[s].next) edges_[s].push_back({Describe(graph, action), to});
      for (const auto& [guard, to] : type.states[s].choice)
        edges_[s].push_back({guard.valid() ? "when " + lang::PrintExpr(pool, guard) : "otherwise", to});
    }
  }

  std::string Run() {
    row_ = RowsOf(edges_);
    std::vector<size_t> state(row_.size());
    for (size_t s = 0; s < row_.size(); ++s) state[row_[s]] = s;
    double y = kMargin + 24;
    top_.resize(row_.size());
    for (const size_t s : state) {
      top_[s] = y;
      y += kHeight + std::max(kGap, kStep * static_cast<double>(edges_[s].size()) + 10);
      for (const Edge& e : edges_[s]) {
        text_ = std::max(text_, Svg::WidthOf(e.text));
        longest_ = std::max(longest_, Distance(s, e.to.index()));
      }
    }
    text_ = std::min(text_, 420.0);
    svg_.Text(kMargin, kMargin, fmt::format("{} in {}", graph_.NameOf(type_.robot), graph_.source->name.text),
              Svg::Anchor::kStart, 600, true);
    for (const size_t s : state) State(s);
    return svg_.Finish(kMargin + kWidth + text_ + 2 * kBow, y + kMargin, graph_.NameOf(type_.robot));
  }

 private:
  size_t Distance(size_t s, size_t to) const {
    return row_[to] > row_[s] ? row_[to] - row_[s] : row_[s] - row_[to];
  }

  void State(size_t s) {
    const double right = kMargin + kWidth, middle = kMargin + kWidth / 2;
    const bool ends = type_.states[s].ends;
    svg_.Rect(kMargin, top_[s], kWidth, kHeight, {ends ? "#cfe8cf" : "#eeeeee", "#333333", false, 10});
    svg_.Text(middle, top_[s] + 16, fmt::format("{}", s), Svg::Anchor::kMiddle, kWidth, s == 0);
    double y = top_[s] + kHeight + 14;
    for (const Edge& e : edges_[s]) {
      const size_t to = e.to.index();
      svg_.Text(right + 10, y, e.text, Svg::Anchor::kStart, text_);
      if (row_[to] == row_[s] + 1) {
        svg_.Arrow(middle, top_[s] + kHeight, middle, top_[to], "#333333");
      } else {
        const double far = static_cast<double>(Distance(s, to)) / static_cast<double>(longest_);
        svg_.Bow(right + 14 + std::min(Svg::WidthOf(e.text), text_), y - 4, right, top_[to] + kHeight / 2,
                 right + text_ + kBow * (0.4 + far), row_[to] > row_[s] ? "#2471a3" : "#c0392b");
      }
      y += kStep;
    }
  }

  const Graph& graph_;
  const LocalType& type_;
  std::vector<std::vector<Edge>> edges_;
  std::vector<size_t> row_;  // by state, from the top
  std::vector<double> top_;
  double text_ = 120;
  size_t longest_ = 1;
  Svg svg_;
};

}  // namespace

std::string DrawAutomaton(const Graph& graph, const lang::ExprPool& pool, const LocalType& type) {
  return Drawing(graph, pool, type).Run();
}

}  // namespace rondo::choreo
