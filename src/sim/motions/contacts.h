#pragma once

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "robot/contact/solid.h"
#include "sim/motions/motion_run.h"
#include "sim/motions/report.h"

namespace rondo::sim::motions {

/// Watches whether bodies touch, and the footprints of their motions: of robots, and of robots and obstacles.
class Contacts {
 public:
  Contacts(const robot::World& world, expr::Arena& arena, const SceneState& scene,
           ChoreographyReport& report);

  /// Looks at the present state, and tells if two begin to touch. `motions`: by robot, the one under way; nullptr if it makes none. Changes no more of the
  /// scene than its clock.
  void Look(SceneState& scene, const std::vector<MotionRun*>& motions, const Tell& tell);

 private:
  struct Thing {
    std::string name;
    std::optional<robot::Solid> solid;
  };
  void Pair(size_t a, size_t b, const Tell& tell);
  void Unchecked(const std::string& what);
  void Touch(Wrong wrong, size_t a, size_t b, bool touches, const Tell& tell);

  std::vector<Thing> things_;  // robots, then obstacles
  size_t robots_ = 0;
  std::vector<bool> stands_;               // by thing: it has a place now
  std::vector<const robot::Solid*> asks_;  // by thing: the space that it asks for now; nullptr: none
  std::set<std::tuple<Wrong, size_t, size_t>> touching_;
  ChoreographyReport& report_;
};

}  // namespace rondo::sim::motions
