#include "sim/bodies/body.h"

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/bodies/models.h"

namespace rondo::sim {

double Distance(const Point& a, const Point& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

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
  tolerance_ = Value("tolerance");
  waypoint_tolerance_ = Value("waypoint_tolerance");
  dwell_ = Value("dwell");
  Reset(position, yaw);
  path_ = {position};
  next_ = 0;
  reached_ = false;
  dwelt_ = 0;
}

void Body::Follow(std::vector<Point> path) {
  if (path.empty()) path = {position()};
  path_ = std::move(path);
  next_ = 0;
  reached_ = false;
  dwelt_ = 0;
  NewCommand();
}

bool Body::Step(double dt, Integrator integrator) {
  const auto away = [&](const Point& p) {
    return flies() ? Distance(position(), p) : std::hypot(state_[0] - p[0], state_[1] - p[1]);
  };
  while (next_ + 1 < path_.size() && away(path_[next_]) < waypoint_tolerance_) ++next_;
  const bool last = next_ + 1 == path_.size();
  Control(path_[next_], last, dt);
  if (!Advance(dt, integrator)) return false;
  AfterStep();
  if (last && away(path_.back()) <= tolerance_) {
    dwelt_ += dt;
    // Half a period of the controller: sums of periods are not exact.
    if (dwelt_ + dt / 2 >= dwell_) reached_ = true;
  } else {
    dwelt_ = 0;
  }
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
