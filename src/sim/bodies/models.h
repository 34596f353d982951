#pragma once

#include "sim/bodies/body.h"

namespace rondo::sim {

/// A double integrator in space: x'' = a with a limit, under a controller of position and speed.
class PointMass final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  Point velocity() const override { return {state_[3], state_[4], state_[5]}; }
  bool flies() const override { return true; }

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  Point acceleration_{};
  double max_speed_ = 0, max_acceleration_ = 0, gain_ = 0, damping_ = 0;
};

/// A plane robot that turns on the spot: x' = v cos(yaw), y' = v sin(yaw), yaw' = w.
class Unicycle final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override;

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double speed_ = 0, turn_ = 0;
  double max_speed_ = 0, max_turn_ = 0, speed_gain_ = 0, turn_gain_ = 0, near_ = 0;
};

/// A kinematic bicycle: yaw' = v tan(steer) / wheelbase. It drives backwards to points behind it.
class Car final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override;

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double speed_ = 0, steer_ = 0;
  double max_speed_ = 0, max_steer_ = 0, wheelbase_ = 0, speed_gain_ = 0, steer_gain_ = 0, near_ = 0;
};

/// An omnidirectional cart: any velocity in the plane up to a limit, with a first-order lag.
class Cart final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override { return {state_[4], state_[5], 0}; }

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double wanted_[2] = {0, 0};
  double max_speed_ = 0, gain_ = 0, lag_ = 0;
};

/// PID(e) = p e + i * integral of e + d * change of e per second.
class Pid {
 public:
  void Gains(double p, double i, double d, double limit = 1e9) {
    p_ = p;
    i_ = i;
    d_ = d;
    limit_ = limit;
  }
  void Forget() {
    sum_ = 0;
    has_last_ = false;
  }
  /// The reference jumped: its change is no speed.
  void ForgetChange() { has_last_ = false; }
  /// `frozen`: the integral stays (anti-windup).
  double operator()(double error, double dt, bool frozen = false);

 private:
  double p_ = 0, i_ = 0, d_ = 0, limit_ = 0;
  double sum_ = 0, last_ = 0;
  bool has_last_ = false;
};

/// A rigid body with the cascaded controller of hector_quadrotor (position, velocity, attitude). State:
/// position, velocity (world), quaternion (w, x, y, z), angular velocity (body).
class Quadrotor final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override;
  std::array<double, 4> rotation() const override { return {state_[7], state_[8], state_[9], state_[6]}; }
  Point velocity() const override { return {state_[3], state_[4], state_[5]}; }
  bool flies() const override { return true; }

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;
  void AfterStep() override;
  void NewCommand() override;

 private:
  std::array<Pid, 3> position_pid_;
  std::array<Pid, 3> velocity_pid_;
  Pid yaw_pid_;
  std::array<Pid, 3> torque_pid_;
  double thrust_ = 0;
  Point torque_{};
  double heading_ = 0;
  double mass_ = 1, max_speed_ = 0, max_climb_ = 0, max_tilt_ = 0;
  bool limited_ = false;
};

}  // namespace rondo::sim
