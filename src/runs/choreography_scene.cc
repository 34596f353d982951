#include "runs/choreography_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "choreo/draw/scene.h"
#include "runs/choreography_runs.h"

namespace rondo::runs {

base::Result<std::string> DrawRunScene(const sim::StageHistory& history, double time,
                                       workspace::Session& session) {
  const auto staged = StageRecorded(history.run, session);
  if (!staged) return base::Error{"the choreography that the trace keeps cannot be used"};
  const robot::World& world = *staged->cast.graph->world;
  expr::Numeric::Point state;
  double shown = 0;
  for (size_t r = 0; r < world.bodies.size() && r < history.states.size(); ++r) {
    const auto& states = history.states[r];
    const auto after = std::ranges::upper_bound(states, time, {}, [](const auto& s) { return s.first; });
    if (after == states.begin()) continue;
    const auto& [at, values] = *std::prev(after);
    shown = std::max(shown, at);
    for (const robot::Variable& v : world.bodies[r].states) {
      const auto it = values.find(v.name.text);
      if (it != values.end()) state.emplace(v.term, it->second);
    }
  }
  constexpr std::array<std::string_view, 4> kFills{"#4080ff", "#ff9020", "#40b060", "#b050c0"},
      kStrokes{"#1040a0", "#a05000", "#106030", "#702080"};
  std::vector<choreo::Drawn> shapes;
  for (const robot::Obstacle& o : world.obstacles)
    shapes.push_back({o.name.text, o.shape, "#666666", "#333333"});
  for (size_t r = 0; r < world.bodies.size(); ++r) {
    const robot::Body& body = world.bodies[r];
    if (body.body) shapes.push_back({body.name.text, *body.body, kFills[r % 4], kStrokes[r % 4]});
  }
  return choreo::DrawScene(staged->module->arena, shapes, state, std::nullopt,
                           fmt::format("{} after {:.6g} s", staged->cast.graph->source->name.text, shown));
}

}  // namespace rondo::runs
