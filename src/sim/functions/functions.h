#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "koord/semantics/team.h"
#include "sim/fleet/fleet.h"
#include "sim/functions/encoding.h"

/// Computes the external functions of programs in simulations.
namespace rondo::sim {

/// Computes the external functions that the simulator knows, by name and signature (`kFunctions` in
/// functions.cc is the list).
class Functions final : public koord::semantics::Host {
 public:
  Functions(const koord::Model& model, const Fleet& fleet, uint64_t seed);

  /// Reports whether the simulator computes function `f`.
  bool Knows(size_t f) const { return f < known_.size() && known_[f] != nullptr; }
  /// Connects the functions with the team that calls them and the bodies that they ask; both must outlive the
  /// calls.
  void Attach(koord::semantics::Team& team, const std::vector<std::unique_ptr<Body>>& bodies);

  koord::semantics::Answer Call(size_t f, size_t robot, std::span<const Word> arguments,
                                std::span<Word> result) override;
  void Log(size_t robot, size_t type, std::span<const Word> value) override;

  /// Is the answer of a planner: it is not finished, or the path; no path: there is none.
  struct Planned {
    bool ready = true;
    std::optional<std::vector<Point>> path;
  };
  using Planner = std::function<Planned(const World& world, const PlanRequest& request)>;
  /// Sets who plans paths; without one, they are there at once.
  void SetPlanner(Planner planner) { planner_ = std::move(planner); }

  /// Returns what robots wrote to streams since the last call: robot and text.
  std::vector<std::pair<size_t, std::string>> TakeLog() { return std::exchange(log_, {}); }
  /// Returns how many paths were planned.
  uint64_t plans() const { return plans_; }

 private:
  using Arguments = std::span<const Word>;
  /// Computes a function for a robot: reads the words of the arguments, and writes those of the result.
  using Handler = void (Functions::*)(size_t robot, Arguments a, std::span<Word> result);
  struct Entry;
  static const Entry kFunctions[];

  Handler Recognise(const koord::Function& f) const;
  /// Returns the map behind a handle. One that was never drawn is a map of which nothing is known.
  GridMap MapOf(Word handle) const;
  Heap& heap() const { return team_->heap(); }

  // On paths: metres.
  void PathIsClear(size_t robot, Arguments a, std::span<Word> result);
  void Apart(size_t robot, Arguments a, std::span<Word> result);
  void Away(size_t robot, Arguments a, std::span<Word> result);
  // On maps and scans.
  void MergeMaps(size_t robot, Arguments a, std::span<Word> result);
  void ScanToMap(size_t robot, Arguments a, std::span<Word> result);
  void PickFrontier(size_t robot, Arguments a, std::span<Word> result);
  void FindObstacles(size_t robot, Arguments a, std::span<Word> result);
  void Right(size_t robot, Arguments a, std::span<Word> result);
  void TrueScan(size_t robot, Arguments a, std::span<Word> result);
  // Behind callable ports.
  void PlanPath(size_t robot, Arguments a, std::span<Word> result);
  void PlanAround(size_t robot, Arguments a, std::span<Word> result);
  void PlanTo(size_t robot, const Point& target, const World& world, std::span<Word> result);

  const koord::Model& model_;
  const Fleet& fleet_;
  uint64_t seed_;
  std::vector<Handler> known_;  ///< by function of the program; nullptr: none of ours
  koord::semantics::Team* team_ = nullptr;
  const std::vector<std::unique_ptr<Body>>* bodies_ = nullptr;
  double path_clearance_;
  uint64_t plans_ = 0;
  uint64_t failures_ = 0;  ///< of them
  Planner planner_;
  bool later_ = false;  ///< the planner of this call is not finished
  std::vector<std::pair<size_t, std::string>> log_;
};

}  // namespace rondo::sim
