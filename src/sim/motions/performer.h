#pragma once

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

/// Is told what a robot does, as it does it.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void Begins(MotionRun& motion) = 0;
  virtual void Ends(const MotionRun& motion) = 0;
  /// A message was taken by whom it is for.
  virtual void Sends(choreo::RobotId /*robot*/, const runtime::sessions::Step& /*message*/) {}
  /// Returns how far a motion is, which is as far as it should be if the body follows.
  virtual runtime::sessions::Progress Checked(const MotionRun& /*motion*/,
                                              runtime::sessions::Progress progress) {
    return progress;
  }
  /// A message is consumed.
  virtual void Takes(choreo::RobotId robot, const runtime::sessions::Expected& message,
                     const std::vector<double>& values) = 0;
};

/// Is one robot of a choreography, without its session: its program, what it senses, and its motions, which move it in a scene.
class Performer final : public runtime::sessions::Program,
                        public runtime::sessions::Motions,
                        private choreo::Senses {
 public:
  /// Everything must outlive it.
  Performer(const choreo::Cast& cast, choreo::RobotId robot, SceneState& scene, MotionLibrary& library,
            std::mt19937_64& random, Manner manner, Audience& audience);
  Performer(const Performer&) = delete;
  Performer& operator=(const Performer&) = delete;

  /// Returns the motion under way; nullptr if there is none.
  MotionRun* motion() { return motion_ ? &*motion_ : nullptr; }
  /// Says why its motion could not begin; empty if all is well.
  const std::string& problem() const { return problem_; }

  runtime::sessions::Step Next() override;
  bool Waits() const override { return script_->Waits(); }
  void Sent() override;
  void Took(size_t which, const std::vector<double>& values) override;
  void Moved() override { script_->Moved(); }

  void Begin(size_t motion) override;
  runtime::sessions::Progress Tick() override;
  void Halt() override;

 private:
  const expr::Numeric::Point& Now() override;
  size_t Pick(size_t count) override { return random_() % count; }
  std::optional<std::vector<double>> Choose(const choreo::Node& message) override;

  const choreo::Cast& cast_;
  SceneState& scene_;
  MotionLibrary& library_;
  std::mt19937_64& random_;
  Manner manner_;
  Audience& audience_;
  choreo::RobotId robot_;
  std::optional<MotionRun> motion_;
  std::string problem_;
  expr::Numeric::Point now_;
  std::unique_ptr<runtime::sessions::Program> script_;
  runtime::sessions::Step step_;  // the present one
};

}  // namespace rondo::sim::motions
