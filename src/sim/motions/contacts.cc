#include "sim/motions/contacts.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::sim::motions {

Contacts::Contacts(const robot::World& world, expr::Arena& arena, const SceneState& scene,
                   ChoreographyReport& report)
    : robots_(world.bodies.size()), report_(report) {
  const auto add = [&](const std::string& name, const robot::Shape* shape) {
    things_.push_back({name, std::nullopt});
    if (shape != nullptr) things_.back().solid = robot::Solid::Of(arena, *shape, scene.variables());
    if (!things_.back().solid) report.unchecked.push_back(fmt::format("whether `{}` touches anything", name));
  };
  for (const robot::Body& body : world.bodies) add(body.name.text, body.body ? &*body.body : nullptr);
  for (const robot::Obstacle& o : world.obstacles) {
    add(o.name.text, &o.shape);
    if (things_.back().solid) things_.back().solid->Place(scene.values());
  }
}

void Contacts::Look(SceneState& scene, const std::vector<MotionRun*>& motions, const Tell& tell) {
  for (size_t i = 0; i < robots_; ++i) {
    if (things_[i].solid) things_[i].solid->Place(scene.values());
    if (motions[i] == nullptr || !motions[i]->code().footprint) continue;
    scene.SetClock(motions[i]->time());
    motions[i]->code().footprint->Place(scene.values());
  }
  for (size_t i = 0; i < robots_; ++i) {
    for (size_t j = i + 1; j < things_.size(); ++j) Pair(i, j, motions, tell);
  }
}

// What obstacles ask for is what they are.
const robot::Solid* Contacts::FootprintOf(size_t thing, const std::vector<MotionRun*>& motions) const {
  if (thing >= robots_) return &*things_[thing].solid;
  if (motions[thing] == nullptr || !motions[thing]->code().footprint) return nullptr;
  return &*motions[thing]->code().footprint;
}

void Contacts::Pair(size_t a, size_t b, const std::vector<MotionRun*>& motions, const Tell& tell) {
  constexpr double kNear = 0.5;  // metres: of bodies that are farther apart, footprints do not meet
  if (!things_[a].solid || !things_[b].solid) return;
  double& least = b < robots_ ? report_.least_between_robots : report_.least_to_obstacles;
  const auto contact = things_[a].solid->With(*things_[b].solid, std::min(least, kNear));
  Touch(Wrong::kCollision, a, b, contact && contact->touches, tell);
  if (contact) least = std::min(least, contact->distance);
  const robot::Solid *x = FootprintOf(a, motions), *y = FootprintOf(b, motions);
  const bool near = !contact || contact->distance < kNear;
  const auto meeting = near && x != nullptr && y != nullptr ? x->With(*y, 0) : std::nullopt;
  Touch(Wrong::kFootprint, a, b, meeting && meeting->touches, tell);
}

void Contacts::Touch(Wrong wrong, size_t a, size_t b, bool touches, const Tell& tell) {
  const std::tuple key(wrong, a, b);
  if (!touches) {
    touching_.erase(key);
    return;
  }
  if (!touching_.insert(key).second) return;
  tell(wrong, wrong == Wrong::kCollision
                  ? fmt::format("`{}` touches `{}`", things_[a].name, things_[b].name)
                  : fmt::format("the footprints of `{}` and `{}` touch", things_[a].name, things_[b].name));
}

}  // namespace rondo::sim::motions
