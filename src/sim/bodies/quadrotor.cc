// Model and controller: hector_quadrotor, kinetic-devel (mass, inertia, drag, the cascade and its limits).
// The second set of gains is the one that CyPhyHouse published for its reachability experiments.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/bodies/models.h"

namespace rondo::sim {

namespace {

constexpr double kGravity = 9.8065;
constexpr Point kInertia{0.01152, 0.01152, 0.0218};                // kg m^2
constexpr Point kDrag{0.12, 0.12, 0.1};                            // N s^2 / m^2
constexpr Point kSpinDrag{0.074156208, 0.074156208, 0.050643264};  // N m s^2
constexpr double kMaxThrust = 30;                                  // N
constexpr double kMaxLoad = 1.5;  // more thrust where it does not point upwards, up to this factor

using Matrix = std::array<std::array<double, 3>, 3>;

// From body to world.
Matrix Rotation(std::span<const double> x) {
  const double w = x[6];
  const double a = x[7];
  const double b = x[8];
  const double c = x[9];
  return {{{1 - 2 * (b * b + c * c), 2 * (a * b - w * c), 2 * (a * c + w * b)},
           {2 * (a * b + w * c), 1 - 2 * (a * a + c * c), 2 * (b * c - w * a)},
           {2 * (a * c - w * b), 2 * (b * c + w * a), 1 - 2 * (a * a + b * b)}}};
}

}  // namespace

double Pid::operator()(double error, double dt, bool frozen) {
  if (!frozen) sum_ = std::clamp(sum_ + i_ * error * dt, -limit_, limit_);
  const double change = has_last_ ? (error - last_) / dt : 0;
  last_ = error;
  has_last_ = true;
  return p_ * error + sum_ + d_ * change;
}

std::vector<BodyParameter> Quadrotor::Parameters() const {
  return {{"mass", 1.477, "kg"},
          {"gains", 0, "0: hector_quadrotor, 1: CyPhyHouse"},
          {"max_speed", 10, "m/s"},
          {"max_climb", 5, "m/s"},
          {"max_tilt", 0.785398, "rad"},
          {"radius", 0.3, "m"},
          {"tolerance", 0.1, "m"},
          {"waypoint_tolerance", 0.3, "m"},
          {"dwell", 1.0, "s"}};
}

void Quadrotor::Prepare() {
  mass_ = Value("mass");
  max_speed_ = Value("max_speed");
  max_climb_ = Value("max_climb");
  max_tilt_ = Value("max_tilt");
  const bool integral = Value("gains") != 0;
  for (size_t i = 0; i < 3; ++i) {
    if (integral)
      position_pid_[i].Gains(2, 1, i == 2 ? 0.5 : 1, 5);
    else
      position_pid_[i].Gains(2, 0, 0, 5);
    velocity_pid_[i].Gains(i == 2 ? 5 : 2, 1, 0, 5);
  }
  if (integral)
    yaw_pid_.Gains(2, 1, 1, 5);
  else
    yaw_pid_.Gains(2, 0, 0, 5);
  torque_pid_[0].Gains(100, 0, 20);
  torque_pid_[1].Gains(100, 0, 20);
  torque_pid_[2].Gains(5, 0, 0.5);
}

void Quadrotor::Reset(const Point& p, double yaw) {
  state_ = {p[0], p[1], p[2], 0, 0, 0, std::cos(yaw / 2), 0, 0, std::sin(yaw / 2), 0, 0, 0};
  heading_ = yaw;
  thrust_ = mass_ * kGravity;
  torque_ = {};
  limited_ = false;
  for (auto* group : {&position_pid_, &velocity_pid_, &torque_pid_}) {
    for (Pid& pid : *group) pid.Forget();
  }
  yaw_pid_.Forget();
}

void Quadrotor::NewCommand() {
  for (Pid& pid : position_pid_) pid.ForgetChange();
}

double Quadrotor::yaw() const {
  const Matrix r = Rotation(state_);
  return std::atan2(r[1][0], r[0][0]);
}

void Quadrotor::Control(const Point& target, bool, double dt) {
  // Position to velocity.
  Point speed{};
  for (size_t i = 0; i < 3; ++i) speed[i] = position_pid_[i](target[i] - state_[i], dt);
  const double flat = std::hypot(speed[0], speed[1]);
  if (flat > max_speed_) {
    for (double& s : speed) s *= max_speed_ / flat;
  }
  speed[2] = std::clamp(speed[2], -max_climb_, max_climb_);
  // Velocity to acceleration, then to attitude in the frame that only yaw turns.
  Point wanted{};
  for (size_t i = 0; i < 3; ++i) wanted[i] = velocity_pid_[i](speed[i] - state_[i + 3], dt, limited_);
  wanted[2] += kGravity;
  const double psi = yaw();
  const double ax = std::cos(psi) * wanted[0] + std::sin(psi) * wanted[1];
  const double ay = -std::sin(psi) * wanted[0] + std::cos(psi) * wanted[1];
  double roll = -std::asin(std::clamp(ay / kGravity, -1.0, 1.0));
  double pitch = std::asin(std::clamp(ax / kGravity, -1.0, 1.0));
  const double tilt = std::hypot(roll, pitch);
  limited_ = tilt > max_tilt_;
  if (limited_) {
    roll *= max_tilt_ / tilt;
    pitch *= max_tilt_ / tilt;
  }
  const Matrix r = Rotation(state_);
  const double load = r[2][2] > 1 / kMaxLoad ? 1 / r[2][2] : kMaxLoad;
  const double lift = mass_ * ((wanted[2] - kGravity) * load + kGravity);
  thrust_ = std::clamp(lift, 0.0, kMaxThrust);
  limited_ = limited_ || thrust_ != lift;
  // Attitude to torque: the direction of the acceleration, seen from the body.
  const Point up{std::sin(pitch), -std::sin(roll), 1};
  const Point world{std::cos(psi) * up[0] - std::sin(psi) * up[1],
                    std::sin(psi) * up[0] + std::cos(psi) * up[1], up[2]};
  Point body{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) body[i] += r[k][i] * world[k];
  }
  const double turn = std::clamp(yaw_pid_(Wrap(heading_ - psi), dt), -std::numbers::pi, std::numbers::pi);
  torque_[0] = std::clamp(kInertia[0] * torque_pid_[0](-body[1], dt), -10.0, 10.0);
  torque_[1] = std::clamp(kInertia[1] * torque_pid_[1](body[0], dt), -10.0, 10.0);
  torque_[2] = std::clamp(kInertia[2] * torque_pid_[2](turn - state_[12], dt), -1.0, 1.0);
}

void Quadrotor::Rate(std::span<const double> x, std::span<double> dx) const {
  const Matrix r = Rotation(x);
  const Point v{x[3], x[4], x[5]};
  const Point w{x[10], x[11], x[12]};
  // Drag acts in the body's frame.
  Point force{0, 0, thrust_};
  for (size_t i = 0; i < 3; ++i) {
    const double along = r[0][i] * v[0] + r[1][i] * v[1] + r[2][i] * v[2];
    force[i] -= kDrag[i] * std::fabs(along) * along;
  }
  for (size_t i = 0; i < 3; ++i) {
    dx[i] = v[i];
    dx[i + 3] =
        (r[i][0] * force[0] + r[i][1] * force[1] + r[i][2] * force[2]) / mass_ - (i == 2 ? kGravity : 0);
  }
  dx[6] = -0.5 * (x[7] * w[0] + x[8] * w[1] + x[9] * w[2]);
  dx[7] = 0.5 * (x[6] * w[0] + x[8] * w[2] - x[9] * w[1]);
  dx[8] = 0.5 * (x[6] * w[1] - x[7] * w[2] + x[9] * w[0]);
  dx[9] = 0.5 * (x[6] * w[2] + x[7] * w[1] - x[8] * w[0]);
  // Euler's equation.
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3;
    const size_t k = (i + 2) % 3;
    const double moment = torque_[i] - kSpinDrag[i] * std::fabs(w[i]) * w[i];
    dx[i + 10] = (moment - (kInertia[k] - kInertia[j]) * w[j] * w[k]) / kInertia[i];
  }
}

void Quadrotor::AfterStep() {
  double norm = 0;
  for (size_t i = 6; i < 10; ++i) norm += state_[i] * state_[i];
  norm = std::sqrt(norm);
  for (size_t i = 6; i < 10; ++i) state_[i] /= norm;
}

}  // namespace rondo::sim
