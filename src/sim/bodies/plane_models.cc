#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/bodies/models.h"

namespace rondo::sim {

namespace {

// What every body has.
std::vector<BodyParameter> With(std::vector<BodyParameter> own, double tolerance, double waypoint,
                                double dwell, double radius) {
  own.push_back({"radius", radius, "m"});
  own.push_back({"tolerance", tolerance, "m"});
  own.push_back({"waypoint_tolerance", waypoint, "m"});
  own.push_back({"dwell", dwell, "s"});
  return own;
}

// The factor that brings a vector of this length down to the limit.
double Scale(double length, double limit) { return std::min(1.0, limit / std::max(length, 1e-12)); }

}  // namespace

// -- point mass

std::vector<BodyParameter> PointMass::Parameters() const {
  return With(
      {{"max_speed", 2, "m/s"}, {"max_acceleration", 2, "m/s^2"}, {"gain", 1, "1/s"}, {"damping", 4, "1/s"}},
      0.1, 0.2, 0.5, 0.2);
}

void PointMass::Prepare() {
  max_speed_ = Value("max_speed");
  max_acceleration_ = Value("max_acceleration");
  gain_ = Value("gain");
  damping_ = Value("damping");
}

void PointMass::Reset(const Point& p, double) { state_ = {p[0], p[1], p[2], 0, 0, 0}; }

void PointMass::Control(const Point& target, bool, double) {
  Point wanted{};
  for (size_t i = 0; i < 3; ++i) wanted[i] = gain_ * (target[i] - state_[i]);
  const double slow = Scale(std::hypot(wanted[0], wanted[1], wanted[2]), max_speed_);
  for (size_t i = 0; i < 3; ++i) acceleration_[i] = damping_ * (wanted[i] * slow - state_[i + 3]);
  const double soft =
      Scale(std::hypot(acceleration_[0], acceleration_[1], acceleration_[2]), max_acceleration_);
  for (double& a : acceleration_) a *= soft;
}

void PointMass::Rate(std::span<const double> x, std::span<double> dx) const {
  for (size_t i = 0; i < 3; ++i) {
    dx[i] = x[i + 3];
    dx[i + 3] = acceleration_[i];
  }
}

// -- unicycle

std::vector<BodyParameter> Unicycle::Parameters() const {
  return With({{"max_speed", 1, "m/s"},
               {"max_turn", 2, "rad/s"},
               {"speed_gain", 1.5, "1/s"},
               {"turn_gain", 3, "1/s"}},
              0.1, 0.2, 0.2, 0.2);
}

void Unicycle::Prepare() {
  max_speed_ = Value("max_speed");
  max_turn_ = Value("max_turn");
  speed_gain_ = Value("speed_gain");
  turn_gain_ = Value("turn_gain");
  near_ = Value("tolerance") / 4;
}

void Unicycle::Reset(const Point& p, double yaw) { state_ = {p[0], p[1], p[2], yaw}; }

Point Unicycle::velocity() const { return {speed_ * std::cos(state_[3]), speed_ * std::sin(state_[3]), 0}; }

void Unicycle::Control(const Point& target, bool last, double) {
  const double dx = target[0] - state_[0];
  const double dy = target[1] - state_[1];
  const double distance = std::hypot(dx, dy);
  if (last && distance < near_) {
    speed_ = turn_ = 0;
    return;
  }
  const double error = Wrap(std::atan2(dy, dx) - state_[3]);
  const double wanted = last ? speed_gain_ * distance : max_speed_;
  speed_ = std::min(max_speed_, wanted) * std::max(0.0, std::cos(error));
  turn_ = std::clamp(turn_gain_ * error, -max_turn_, max_turn_);
}

void Unicycle::Rate(std::span<const double> x, std::span<double> dx) const {
  dx[0] = speed_ * std::cos(x[3]);
  dx[1] = speed_ * std::sin(x[3]);
  dx[2] = 0;
  dx[3] = turn_;
}

std::optional<Twist> Unicycle::Told() const { return Twist{speed_, 0, turn_, 0}; }

void Unicycle::Tell(const Twist& twist) {
  speed_ = std::clamp(twist.forward, -max_speed_, max_speed_);
  turn_ = std::clamp(twist.turn, -max_turn_, max_turn_);
}

// -- car

std::vector<BodyParameter> Car::Parameters() const {
  return With({{"max_speed", 1.5, "m/s"},
               {"max_steer", 0.6, "rad"},
               {"wheelbase", 0.33, "m"},
               {"speed_gain", 1.5, "1/s"},
               {"steer_gain", 2, ""}},
              0.25, 0.25, 0.2, 0.25);
}

void Car::Prepare() {
  max_speed_ = Value("max_speed");
  max_steer_ = Value("max_steer");
  wheelbase_ = Value("wheelbase");
  speed_gain_ = Value("speed_gain");
  steer_gain_ = Value("steer_gain");
  near_ = Value("tolerance") / 2;
}

void Car::Reset(const Point& p, double yaw) { state_ = {p[0], p[1], p[2], yaw}; }

Point Car::velocity() const { return {speed_ * std::cos(state_[3]), speed_ * std::sin(state_[3]), 0}; }

void Car::Control(const Point& target, bool last, double) {
  const double dx = target[0] - state_[0];
  const double dy = target[1] - state_[1];
  const double distance = std::hypot(dx, dy);
  if (last && distance < near_) {
    speed_ = steer_ = 0;
    return;
  }
  double error = Wrap(std::atan2(dy, dx) - state_[3]);
  double direction = 1;
  if (std::fabs(error) > std::numbers::pi / 2) {
    direction = -1;
    error = Wrap(error + std::numbers::pi);
  }
  steer_ = direction * std::clamp(steer_gain_ * error, -max_steer_, max_steer_);
  const double wanted = last ? speed_gain_ * distance : max_speed_;
  speed_ = direction * std::clamp(wanted * std::max(0.3, std::cos(error)), 0.0, max_speed_);
}

void Car::Rate(std::span<const double> x, std::span<double> dx) const {
  dx[0] = speed_ * std::cos(x[3]);
  dx[1] = speed_ * std::sin(x[3]);
  dx[2] = 0;
  dx[3] = speed_ * std::tan(steer_) / wheelbase_;
}

std::optional<Twist> Car::Told() const {
  return Twist{speed_, 0, speed_ * std::tan(steer_) / wheelbase_, steer_};
}

// Who says how fast it is to turn says how far it has to steer.
void Car::Tell(const Twist& twist) {
  speed_ = std::clamp(twist.forward, -max_speed_, max_speed_);
  const bool turns = twist.steer == 0 && twist.turn != 0;
  const double steer = !turns ? twist.steer : speed_ == 0 ? 0 : std::atan(twist.turn * wheelbase_ / speed_);
  steer_ = std::clamp(steer, -max_steer_, max_steer_);
}

// -- cart

std::vector<BodyParameter> Cart::Parameters() const {
  return With({{"max_speed", 0.8, "m/s"}, {"gain", 1.5, "1/s"}, {"lag", 0.1, "s"}}, 0.05, 0.15, 0.2, 0.25);
}

void Cart::Prepare() {
  max_speed_ = Value("max_speed");
  gain_ = Value("gain");
  lag_ = Value("lag");
}

void Cart::Reset(const Point& p, double yaw) { state_ = {p[0], p[1], p[2], yaw, 0, 0}; }

void Cart::Control(const Point& target, bool, double) {
  const double x = gain_ * (target[0] - state_[0]);
  const double y = gain_ * (target[1] - state_[1]);
  const double slow = Scale(std::hypot(x, y), max_speed_);
  wanted_[0] = x * slow;
  wanted_[1] = y * slow;
}

void Cart::Rate(std::span<const double> x, std::span<double> dx) const {
  dx[0] = x[4];
  dx[1] = x[5];
  dx[2] = dx[3] = 0;
  dx[4] = (wanted_[0] - x[4]) / lag_;
  dx[5] = (wanted_[1] - x[5]) / lag_;
}

std::optional<Twist> Cart::Told() const {
  const double c = std::cos(yaw()), n = std::sin(yaw());
  return Twist{c * wanted_[0] + n * wanted_[1], c * wanted_[1] - n * wanted_[0], 0, 0};
}

void Cart::Tell(const Twist& twist) {
  const double c = std::cos(yaw()), n = std::sin(yaw());
  const double slow = Scale(std::hypot(twist.forward, twist.left), max_speed_);
  wanted_[0] = slow * (c * twist.forward - n * twist.left);
  wanted_[1] = slow * (n * twist.forward + c * twist.left);
}

}  // namespace rondo::sim
