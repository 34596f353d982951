#include "sim/motions/beginning.h"

#include <algorithm>

#include "choreo/prove/sampler.h"
#include "sim/motions/condition.h"

namespace rondo::sim::motions {

bool Place(const choreo::Graph& graph, expr::Arena& arena, SceneState& scene, std::mt19937_64& random) {
  std::vector<expr::TermId> allowed{graph.initially};
  std::vector<std::pair<expr::TermId, std::pair<double, double>>> ranges;
  expr::Numeric numeric(arena, {});
  for (const robot::Body& body : graph.world->bodies) {
    for (const auto* list : {&body.states, &body.unknowns}) {
      for (const robot::Variable& v : *list) {
        if (v.least) allowed.push_back(arena.Le(*v.least, v.term));
        if (v.most) allowed.push_back(arena.Le(v.term, *v.most));
        if (!v.least || !v.most) continue;
        ranges.emplace_back(v.term, std::pair(numeric(*v.least), numeric(*v.most)));
      }
    }
  }
  constexpr int kTries = 1000;
  for (const auto& [term, range] : ranges) scene[term] = Between(random, range.first, range.second);
  const auto point = choreo::Sampler(arena, arena.And(allowed)).Draw(random, kTries);
  if (!point) return false;
  for (size_t i = 0; i < scene.variables().size(); ++i) {
    const auto it = point->find(scene.variables()[i]);
    if (it != point->end()) scene.values()[i] = it->second;
  }
  return true;
}

std::vector<size_t> CarriersFirst(const robot::World& world) {
  std::vector<std::pair<size_t, size_t>> depths;
  for (size_t r = 0; r < world.bodies.size(); ++r) {
    size_t depth = 0;
    for (auto parent = world.bodies[r].parent; parent; parent = world.bodies[*parent].parent) ++depth;
    depths.emplace_back(depth, r);
  }
  std::ranges::sort(depths);
  std::vector<size_t> order;
  for (const auto& [depth, r] : depths) order.push_back(r);
  return order;
}

}  // namespace rondo::sim::motions
