#pragma once

#include "sim/bodies/body.h"

/// Declares the bodies that fleets can name, each with its dynamics and controller. Lengths in metres, angles
/// in radians.
namespace rondo::sim {

/// Models a double integrator in space: x'' = a with a limit on the acceleration, under a controller of
/// position and speed.
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

/// Models a plane robot that turns on the spot: x' = v cos(yaw), y' = v sin(yaw), yaw' = w.
class Unicycle final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override;
  std::optional<Twist> Told() const override;

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Tell(const Twist& twist) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double speed_ = 0, turn_ = 0;
  double max_speed_ = 0, max_turn_ = 0, speed_gain_ = 0, turn_gain_ = 0, near_ = 0;
};

/// Models a kinematic bicycle: yaw' = v tan(steer) / wheelbase. It drives backwards to points behind it.
class Car final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override;
  std::optional<Twist> Told() const override;

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Tell(const Twist& twist) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double speed_ = 0, steer_ = 0;
  double max_speed_ = 0, max_steer_ = 0, wheelbase_ = 0, speed_gain_ = 0, steer_gain_ = 0, near_ = 0;
};

/// Models an omnidirectional cart: any velocity in the plane up to a limit, with a first-order lag.
class Cart final : public Body {
 public:
  std::vector<BodyParameter> Parameters() const override;
  double yaw() const override { return state_[3]; }
  Point velocity() const override { return {state_[4], state_[5], 0}; }
  std::optional<Twist> Told() const override;

 protected:
  void Prepare() override;
  void Reset(const Point& position, double yaw) override;
  void Control(const Point& target, bool last, double dt) override;
  void Tell(const Twist& twist) override;
  void Rate(std::span<const double> x, std::span<double> dx) const override;

 private:
  double wanted_[2] = {0, 0};
  double max_speed_ = 0, gain_ = 0, lag_ = 0;
};

/// Computes PID(e) = p e + i * integral of e + d * change of e per second. The integral part stays within
/// [-limit, limit].
class Pid {
 public:
  void Gains(double p, double i, double d, double limit = 1e9) {
    p_ = p;
    i_ = i;
    d_ = d;
    limit_ = limit;
  }
  /// Begins anew: forgets the integral and the last error.
  void Forget() {
    sum_ = 0;
    has_last_ = false;
  }
  /// Forgets the last error, for when the reference jumps: that change is no speed.
  void ForgetChange() { has_last_ = false; }
  /// Returns the output for an error that lasts `dt` seconds. `frozen`: the integral stays as it is
  /// (anti-windup).
  double operator()(double error, double dt, bool frozen = false);

 private:
  double p_ = 0, i_ = 0, d_ = 0, limit_ = 0;
  double sum_ = 0, last_ = 0;
  bool has_last_ = false;
};

/// Models a rigid body with the cascaded controller of hector_quadrotor (position, velocity, attitude).
/// State: position and velocity (world frame), quaternion (w, x, y, z), angular velocity (body frame).
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
