#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "koord/semantics/team.h"
#include "sim/fleet/fleet.h"
#include "sim/functions/grid_map.h"

namespace rondo::sim {

using koord::semantics::Heap;
using koord::semantics::Word;

/// How maps, scans and cells are kept in words. The handle 0 is a map of which nothing is known.
Word EncodeMap(Heap& heap, const GridMap& map);
std::optional<GridMap> DecodeMap(const Heap& heap, Word handle);
Word EncodeRays(Heap& heap, const Rays& rays);
Rays DecodeRays(const Heap& heap, Word handle);
Word EncodePath(Heap& heap, const std::vector<Point>& path);
std::vector<Point> DecodePath(const Heap& heap, Word handle);

/// The external functions that the simulator knows, by name and signature: `pathIsClear`, `apart`, `away` on
/// paths; `merge`, `scanToMap`, `pickFrontierPos`, `findObs`, `right`, `true_scan` on maps; planners behind
/// callable ports.
class Functions final : public koord::semantics::Host {
 public:
  Functions(const koord::Model& model, const Fleet& fleet, uint64_t seed);

  /// Does the simulator compute function `f`?
  bool Knows(size_t f) const { return f < known_.size() && known_[f] != Known::kNone; }
  void Attach(koord::semantics::Team& team, const std::vector<std::unique_ptr<Body>>& bodies);

  bool Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) override;
  void Log(size_t robot, size_t type, std::span<const Word> value) override;

  /// What robots wrote to streams since the last call: robot and text.
  std::vector<std::pair<size_t, std::string>> TakeLog() { return std::exchange(log_, {}); }
  uint64_t plans() const { return plans_; }

 private:
  enum class Known : uint8_t {
    kNone,
    kPathIsClear,
    kApart,
    kAway,
    kMerge,
    kScanToMap,
    kPickFrontier,
    kFindObs,
    kRight,
    kTrueScan,
    kPlanner,
    kPlannerWithObstacles,
  };
  Known Recognise(const koord::Function& f) const;
  bool Planner(size_t robot, const Point& target, const World& world, std::span<Word> result);

  const koord::Model& model_;
  const Fleet& fleet_;
  uint64_t seed_;
  std::vector<Known> known_;
  koord::semantics::Team* team_ = nullptr;
  const std::vector<std::unique_ptr<Body>>* bodies_ = nullptr;
  double path_clearance_;
  uint64_t plans_ = 0;
  std::vector<std::pair<size_t, std::string>> log_;
};

}  // namespace rondo::sim
