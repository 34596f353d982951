#include "sim/motions/disturbances.h"

#include <algorithm>
#include <cmath>

namespace rondo::sim::motions {

namespace {
constexpr double kHold = 2, kWay = 0.1;  // seconds
}  // namespace

Disturbances::Disturbances(const robot::World& world, const expr::Arena& arena, SceneState& scene,
                           std::mt19937_64& random)
    : scene_(scene), random_(random) {
  expr::Numeric numeric(arena, {});
  const auto add = [&](const std::vector<robot::Variable>& list) {
    for (const robot::Variable& v : list) {
      if (!v.least || !v.most) continue;
      One one{scene_.Of(v.term), numeric(*v.least), numeric(*v.most), 0, 0, 0, 0};
      one.from = one.to = Value(one);
      scene_.values()[one.place] = one.to;
      all_.push_back(one.place);
      ones_.push_back(one);
    }
  };
  for (const robot::Body& body : world.bodies) add(body.inputs);
  add(world.environment);
}

double Disturbances::Value(const One& one) {
  if (random_() % 2 == 0) return random_() % 2 == 0 ? one.low : one.high;
  return Between(random_, one.low, one.high);
}

void Disturbances::To(double seconds, const std::vector<bool>& set) {
  for (One& one : ones_) {
    while (seconds >= one.ends) {
      one.from = one.to;
      one.to = Value(one);
      one.begins = one.ends - kHold * std::log1p(-Between(random_, 0, 1));
      one.ends = one.begins + kWay;
    }
    if (set[one.place]) continue;
    const double share = std::clamp((seconds - one.begins) / kWay, 0.0, 1.0);
    scene_.values()[one.place] = one.from + share * (one.to - one.from);
  }
}

}  // namespace rondo::sim::motions
