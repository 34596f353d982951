#pragma once

#include <map>
#include <memory>
#include <random>

#include "reach/problem/numeric.h"
#include "sim/models/robot_code.h"

namespace rondo::sim {

/// Models a robot of a type that a model describes. Its states are integrated from the code that proofs are
/// about, its controller acts at the instants 0, period, 2 period, ... of the run, whatever the steps, and its
/// events happen where their condition begins to hold, unless it holds for less than a step.
///
/// Disturbances, the inputs that nobody sets, keep a value of their range for a second on average: in half of
/// the cases one of its ends. A body that has a port `target` goes through waypoints like all bodies.
class ModelledBody final : public Body {
 public:
  /// @param initial  values of states, memory and inputs at the start, by name, in SI units; others start at
  /// zero.
  ModelledBody(std::shared_ptr<const RobotCode> code, std::map<std::string, double> initial);

  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override;
  std::array<double, 4> rotation() const override;
  Point velocity() const override;
  bool AtRest() const override;
  bool flies() const override { return code_->position[2] < code_->states; }
  std::optional<BodyPort> FindPort(std::string_view name) const override;
  void ReadPort(const BodyPort& port, std::span<double> values) const override;
  void WritePort(const BodyPort& port, std::span<const double> values) override;
  std::vector<std::string> TakeBroken() override;
  void Seed(uint64_t seed) override { random_.seed(seed); }

 protected:
  void Prepare() override {}
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;
  bool Advance(double dt, Integrator integrator) override;

 private:
  void Disturb(double dt);
  void Apply(const RobotUpdate& update, reach::Evaluator& evaluator);
  bool Holds(const RobotFormula& formula, reach::Evaluator& evaluator) const;
  bool Settle();
  bool Flow(double& step, Integrator integrator);
  void FindPlace();
  void Watch();

  std::shared_ptr<const RobotCode> code_;
  std::map<std::string, double> initial_;
  std::vector<double> x_;  // by variable
  std::vector<double> states_;
  // Evaluators remember the values of their nodes; each thread has its own bodies.
  mutable reach::Evaluator rates_, laws_, place_;
  mutable std::vector<reach::Evaluator> ports_;
  std::vector<reach::Evaluator> conditions_, updates_;
  mutable std::vector<double> all_, outputs_;
  std::vector<size_t> target_;  // the inputs of the port `target`
  std::array<double, 12> frame_{};
  Point offset_{};
  double turned_ = 0;
  double time_ = 0;
  double changed_ = 0;  // when a controller or an event set something else than before
  uint64_t samples_ = 0;
  std::vector<bool> was_broken_;
  std::vector<std::string> broken_;
  std::mt19937_64 random_;
};

}  // namespace rondo::sim
