#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bodies/integrator.h"

namespace rondo::sim {

using Point = std::array<double, 3>;  ///< metres, world frame

double Distance(const Point& a, const Point& b);
/// The angle between -pi and pi that points the same way.
double Wrap(double angle);

/// A parameter of a model: its name, default and unit.
struct BodyParameter {
  std::string_view name;
  double value;
  std::string_view unit;
};

/// A robot's body with its controller: it goes through waypoints, one after the other. The port `target` is a
/// path of one point.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  /// At rest at `position`, heading `yaw`; it holds its position, and has reached it after its dwell time.
  /// Call after `Set`.
  void Place(const Point& position, double yaw);
  /// A new command: go through these points. Empty: stop here.
  void Follow(std::vector<Point> path);
  /// Time passes: the controller acts, then the body moves, for one period of the controller. False if the
  /// state is no longer finite.
  bool Step(double dt, Integrator integrator);

  /// Did it arrive at the last point of its path, and stay for its dwell time?
  bool reached() const { return reached_; }
  Point position() const { return {state_[0], state_[1], state_[2]}; }
  virtual double yaw() const { return 0; }
  /// Quaternion x, y, z, w.
  virtual std::array<double, 4> rotation() const;
  virtual Point velocity() const = 0;
  virtual bool flies() const { return false; }
  double radius() const { return Value("radius"); }
  const std::vector<Point>& path() const { return path_; }

  virtual std::vector<BodyParameter> Parameters() const = 0;
  void Set(const std::string& name, double value) { values_[name] = value; }
  double Value(std::string_view name) const;

 protected:
  /// Reads the parameters.
  virtual void Prepare() = 0;
  virtual void Reset(const Point& position, double yaw) = 0;
  /// Sets the inputs for the next period. `last`: the point is the end of the path.
  virtual void Control(const Point& target, bool last, double dt) = 0;
  virtual void Rate(std::span<const double> x, std::span<double> dx) const = 0;
  virtual void AfterStep() {}
  virtual void NewCommand() {}

  std::vector<double> state_;  ///< the first three are the position

 private:
  std::map<std::string, double, std::less<>> values_;
  std::vector<Point> path_;
  size_t next_ = 0;
  double dwelt_ = 0;
  double dwell_ = 0;
  double tolerance_ = 0;
  double waypoint_tolerance_ = 0;
  bool reached_ = false;
};

/// `point_mass`, `unicycle`, `car`, `cart`, `quadrotor`; nullptr for any other name.
std::unique_ptr<Body> MakeBody(std::string_view model);
std::vector<std::string> BodyModels();

}  // namespace rondo::sim
