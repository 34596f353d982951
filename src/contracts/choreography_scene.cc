#include "contracts/choreography_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>

#include "choreo/draw/scene.h"
#include "choreo/prove/sampler.h"

namespace rondo::contracts {

std::string SceneOf(const ChoreographyProof& report, expr::Arena& arena) {
  const choreo::Graph& graph = *report.graph;
  const choreo::Obligation* failed = nullptr;
  expr::Numeric::Point state;
  std::string title = fmt::format("{}, as it begins", graph.source->name.text);
  for (size_t i = 0; i < report.obligations.all.size() && failed == nullptr; ++i) {
    const auto& [o, d] = std::tie(report.obligations.all[i], report.proofs.all[i].decision);
    if (!o.meeting || d.verdict == verdict::Verdict::kProved || d.witness.values.empty()) continue;
    failed = &o;
    state = d.witness.values;
    title = o.failure;
  }
  if (failed == nullptr) {
    std::mt19937_64 random(1);
    if (auto begins = choreo::Sampler(arena, graph.initially).Draw(random, 1000)) state = std::move(*begins);
  }
  std::optional<std::array<double, 3>> mark;
  std::array<double, 3> at{};
  size_t known = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto it = state.find(graph.world->point[i]);
    if (it != state.end()) at[i] = it->second, ++known;
  }
  if (known == 3) mark = at;
  std::vector<choreo::Drawn> shapes;
  for (const robot::Obstacle& o : graph.world->obstacles)
    shapes.push_back({o.name.text, o.shape, "#666666", "#333333"});
  for (const robot::Body& b : graph.world->bodies) {
    const bool placed = std::ranges::all_of(b.states, [&](const auto& v) { return state.contains(v.term); });
    if (b.body && placed) shapes.push_back({b.name.text, *b.body, "#bbbbbb", "#777777"});
  }
  if (failed != nullptr) {
    constexpr std::array<std::string_view, 2> kFills{"#4080ff", "#ff9020"}, kStrokes{"#1040a0", "#a05000"};
    for (size_t i = 0; i < failed->meeting->shapes.size() && i < 2; ++i)
      shapes.push_back({"", failed->meeting->shapes[i], kFills[i], kStrokes[i]});
  }
  return choreo::DrawScene(arena, shapes, state, mark, title);
}

}  // namespace rondo::contracts
