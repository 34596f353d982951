#pragma once

#include <map>
#include <optional>
#include <random>
#include <set>

#include "robot/contact/solid.h"
#include "sim/motions/motion_run.h"
#include "sim/motions/places.h"
#include "sim/motions/report.h"

namespace rondo::sim::motions {

/// Watches what a choreography promises of its threads and messages: that footprints stay in their regions, that threads keep what they
/// guarantee, and that messages are sent and carry what they may.
class Promises {
 public:
  /// Everything must outlive it.
  Promises(const choreo::Cast& cast, const SceneState& scene, std::mt19937_64& random);

  /// Looks at the motion of a robot that is under way, whose footprint stands where it is now. Points of it are drawn at random.
  void Look(SceneState& scene, const MotionRun& motion, const Places& places, const Tell& tell);
  /// Looks at a message that is taken now, one of `nodes`.
  void Look(SceneState& scene, const std::vector<choreo::NodeId>& nodes, const std::vector<double>& values,
            const Tell& tell);

 private:
  struct Thread {
    std::optional<Condition> region, guarantee;
  };
  Thread& ThreadOf(choreo::NodeId fork, size_t branch);
  std::vector<std::vector<double>> PointsOf(const robot::Solid& footprint, const SceneState& scene);
  std::set<Wrong> Broken(choreo::NodeId fork, size_t branch, const SceneState& scene,
                         const std::vector<std::vector<double>>& points);

  const choreo::Cast& cast_;
  std::mt19937_64& random_;
  std::vector<expr::TermId> variables_;  // of the scene
  std::map<std::pair<choreo::NodeId, size_t>, Thread> threads_;
};

}  // namespace rondo::sim::motions
