#include "sim/bodies/body.h"

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/bodies/models.h"

namespace rondo::sim {

double Wrap(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle - kTurn * std::floor((angle + std::numbers::pi) / kTurn);
}

double Body::Value(std::string_view name) const {
  const auto it = values_.find(name);
  if (it != values_.end()) return it->second;
  for (const BodyParameter& p : Parameters()) {
    if (p.name == name) return p.value;
  }
  CHECK(false) << "a body has no parameter " << name;
  return 0;
}

std::array<double, 4> Body::rotation() const { return {0, 0, std::sin(yaw() / 2), std::cos(yaw() / 2)}; }

bool Body::AtRest() const {
  constexpr double kSlow = 1e-3;  // m/s
  return Distance(velocity(), Point{}) < kSlow;
}

bool Body::Advance(double dt, Integrator integrator) {
  const Derivative f = [this](std::span<const double> x, std::span<double> dx) { Rate(x, dx); };
  return Integrate(integrator, f, state_, dt);
}

void Body::Place(const Point& position, double yaw) {
  Prepare();
  Reset(position, yaw);
  way_.Begin({position}, {Value("tolerance"), Value("waypoint_tolerance"), Value("dwell"), flies()});
}

void Body::Follow(std::vector<Point> path) {
  if (path.empty()) path = {position()};
  way_.Begin(std::move(path));
  NewCommand();
}

void Body::Decide(double dt) {
  const Point& next = way_.Next(position());
  Control(next, way_.last(), dt);
}

bool Body::Step(double dt, Integrator integrator) {
  Decide(dt);
  return Pass(dt, integrator);
}

bool Body::Drive(const Twist& twist, double dt, Integrator integrator) {
  Tell(twist);
  return Pass(dt, integrator);
}

bool Body::Pass(double dt, Integrator integrator) {
  if (!Advance(dt, integrator)) return false;
  AfterStep();
  way_.Pass(position(), dt);
  return true;
}

namespace {

template <typename Model>
std::unique_ptr<Body> Make() {
  return std::make_unique<Model>();
}

/// The bodies that fleets can name: this list is the only one.
struct BodyModel {
  std::string_view name;
  std::unique_ptr<Body> (*make)();
};
constexpr BodyModel kModels[] = {{"point_mass", Make<PointMass>},
                                 {"unicycle", Make<Unicycle>},
                                 {"car", Make<Car>},
                                 {"cart", Make<Cart>},
                                 {"quadrotor", Make<Quadrotor>}};

}  // namespace

std::unique_ptr<Body> MakeBody(std::string_view model) {
  for (const BodyModel& m : kModels) {
    if (m.name == model) return m.make();
  }
  return nullptr;
}

std::vector<std::string> BodyModels() {
  std::vector<std::string> names;
  for (const BodyModel& m : kModels) names.emplace_back(m.name);
  return names;
}

}  // namespace rondo::sim
