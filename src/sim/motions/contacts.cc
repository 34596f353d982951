#include "sim/motions/contacts.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::sim::motions {

Contacts::Contacts(const robot::World& world, expr::Arena& arena, const SceneState& scene,
                   ChoreographyReport& report)
    : robots_(world.bodies.size()), stands_(robots_), asks_(robots_), report_(report) {
  things_.reserve(robots_ + world.obstacles.size());  // others point to them
  const auto add = [&](const std::string& name, const robot::Shape* shape) {
    things_.push_back({name, std::nullopt});
    if (shape != nullptr) things_.back().solid = robot::Solid::Of(arena, *shape, scene.variables());
    if (!things_.back().solid) report.unchecked.push_back(fmt::format("whether `{}` touches anything", name));
  };
  for (const robot::Body& body : world.bodies) add(body.name.text, body.body ? &*body.body : nullptr);
  for (const robot::Obstacle& o : world.obstacles) {
    add(o.name.text, &o.shape);
    const bool stands = things_.back().solid && things_.back().solid->Place(scene.values());
    // What obstacles ask for is what they are.
    stands_.push_back(stands);
    asks_.push_back(stands ? &*things_.back().solid : nullptr);
  }
}

void Contacts::Look(SceneState& scene, const std::vector<MotionRun*>& motions, const Tell& tell) {
  for (size_t i = 0; i < robots_; ++i) {
    stands_[i] = things_[i].solid && things_[i].solid->Place(scene.values());
    if (things_[i].solid && !stands_[i])
      Unchecked(fmt::format("where `{}` is: it has no value there", things_[i].name));
    asks_[i] = nullptr;
    if (motions[i] == nullptr) continue;
    MotionCode& motion = motions[i]->code();
    if (motion.unseen) Unchecked(fmt::format("the footprint of `{}`", motion.text));
    scene.SetClock(motions[i]->time());
    if (motion.footprint && motion.footprint->Place(scene.values())) asks_[i] = &*motion.footprint;
  }
  for (size_t i = 0; i < robots_; ++i) {
    for (size_t j = i + 1; j < things_.size(); ++j) Pair(i, j, tell);
  }
}

void Contacts::Unchecked(const std::string& what) {
  if (std::ranges::find(report_.unchecked, what) == report_.unchecked.end())
    report_.unchecked.push_back(what);
}

void Contacts::Pair(size_t a, size_t b, const Tell& tell) {
  constexpr double kNear =
      0.5;  // metres: how far apart those are that are farther, nobody needs to know exactly
  if (stands_[a] && stands_[b]) {
    double& least = b < robots_ ? report_.least_between_robots : report_.least_to_obstacles;
    const auto contact = things_[a].solid->With(*things_[b].solid, std::min(least, kNear));
    Touch(Wrong::kCollision, a, b, contact && contact->touches, tell);
    if (contact) least = std::min(least, contact->distance);
  }
  if (asks_[a] == nullptr || asks_[b] == nullptr) return;
  const auto meeting = asks_[a]->With(*asks_[b], 0);
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
