#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "choreo/node/cast.h"
#include "sim/motions/motion_run.h"

namespace rondo::sim::motions {

/// Keeps the code of motions, each made when it first begins.
class MotionLibrary {
 public:
  MotionLibrary(const choreo::Graph& graph, expr::Arena& arena, const SceneState& scene)
      : graph_(graph), arena_(arena), scene_(scene) {}

  /// Returns the code of an instance of the graph. @error says why it cannot be simulated.
  base::Result<MotionCode*> Find(size_t instance);

 private:
  const choreo::Graph& graph_;
  expr::Arena& arena_;
  const SceneState& scene_;
  std::map<size_t, std::unique_ptr<MotionCode>> known_;
};

/// Is one simulated robot of a choreography: its program with its session, what it senses, and its motions.
class Performer final : public runtime::sessions::Motions, public choreo::Senses {
 public:
  /// Is told when a motion begins, with what was wrong at that moment, and when it is over.
  using Began = std::function<void(MotionRun&)>;
  using Over = std::function<void(const MotionRun&)>;

  /// Everything must outlive it.
  Performer(const choreo::Cast& cast, choreo::RobotId robot, SceneState& scene, MotionLibrary& library,
            std::mt19937_64& random, Began began, Over over);
  Performer(const Performer&) = delete;
  Performer& operator=(const Performer&) = delete;

  runtime::sessions::Session& session() { return *session_; }
  const runtime::sessions::Session& session() const { return *session_; }
  /// Returns the motion under way; nullptr if there is none.
  MotionRun* motion() { return motion_ ? &*motion_ : nullptr; }
  /// Says why its motion could not begin; empty if all is well.
  const std::string& problem() const { return problem_; }

  void Begin(size_t motion) override;
  runtime::sessions::Progress Tick() override;
  void Halt() override;

  const expr::Numeric::Point& Now() override;
  size_t Pick(size_t count) override { return random_() % count; }
  std::optional<std::vector<double>> Choose(const choreo::Node& message) override;

 private:
  const choreo::Cast& cast_;
  SceneState& scene_;
  MotionLibrary& library_;
  std::mt19937_64& random_;
  Began began_;
  Over over_;
  std::optional<MotionRun> motion_;
  std::string problem_;
  expr::Numeric::Point now_;
  std::unique_ptr<runtime::sessions::Program> program_;
  std::optional<runtime::sessions::Session> session_;
};

}  // namespace rondo::sim::motions
