#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bodies/integrator.h"
#include "sim/bodies/waypoints.h"

/// Models the bodies of simulated robots.
namespace rondo::sim {

/// Returns the angle in [-pi, pi) that points the same way; radians.
double Wrap(double angle);

/// Describes a parameter of a model: its name, default and unit.
struct BodyParameter {
  std::string_view name;
  double value;
  std::string_view unit;
};

/// Describes a port of a body: what a program reads, or sets.
struct BodyPort {
  enum class Kind : uint8_t { kNumber, kPoint, kBool };
  size_t number = 0;  ///< in the order of the body's ports
  Kind kind = Kind::kNumber;
  bool settable = false;  ///< an actuator; others can only be read
};

/// Is how a robot in the plane is told to move, in its own frame: m/s and rad/s.
struct Twist {
  double forward = 0, left = 0, turn = 0;
  double steer = 0;  ///< of what steers: the angle of the front wheels in radians
};

/// Models a robot's body with its controller, which goes through waypoints, one after the other. What a
/// program writes to the port `target` is a path of one point.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  /// Puts the body at rest at `position` (metres, world frame), heading `yaw` (radians). It holds its
  /// position, and has reached it after its dwell time. Reads the parameters, so `Set` has to come before.
  void Place(const Point& position, double yaw);
  /// Commands the body to go through these points. Without points it stops where it is.
  void Follow(std::vector<Point> path);
  /// Lets one period of the controller pass, `dt` seconds: the controller acts, then the body moves. Returns
  /// false if the state is no longer finite.
  bool Step(double dt, Integrator integrator);

  /// Returns what the controller tells the wheels; nothing if the body is not driven by velocities in the plane.
  virtual std::optional<Twist> Told() const { return std::nullopt; }
  /// Puts a body that is driven so where it is measured to be; it goes on along its path.
  void Put(const Point& position, double yaw) { Reset(position, yaw); }
  /// Lets the controller act for a period of `dt` seconds; nothing moves.
  void Decide(double dt);
  /// Lets `dt` seconds pass in which the wheels do this, whatever the controller would say.
  bool Drive(const Twist& twist, double dt, Integrator integrator);

  /// Reports whether it arrived at the last point of its path, within its tolerance, and stayed for its dwell
  /// time.
  bool reached() const { return way_.reached(); }
  Point position() const { return {state_[0], state_[1], state_[2]}; }
  /// Returns the heading in radians, from the x axis of the world; 0 for what has none.
  virtual double yaw() const { return 0; }
  /// Returns how the body is turned in the world, as a quaternion x, y, z, w.
  virtual std::array<double, 4> rotation() const;
  /// Returns the velocity in m/s, world frame.
  virtual Point velocity() const = 0;
  /// Reports whether nothing changes: it stays where it is, and so does all else that its sensors read.
  virtual bool AtRest() const;
  /// Reports whether it moves in space; else heights of waypoints do not matter.
  virtual bool flies() const { return false; }
  double radius() const { return Value("radius"); }
  const std::vector<Point>& path() const { return way_.path(); }

  /// Lists the parameters of the model. All models have `radius`, `tolerance`, `waypoint_tolerance` (metres)
  /// and `dwell` (seconds).
  virtual std::vector<BodyParameter> Parameters() const = 0;
  /// Finds a port that the body has beside those of all bodies, such as the charge of its battery; nothing if
  /// there is none.
  virtual std::optional<BodyPort> FindPort(std::string_view) const { return std::nullopt; }
  /// Reads or sets a port that was found; `values` has one number for each of its parts.
  virtual void ReadPort(const BodyPort&, std::span<double>) const {}
  virtual void WritePort(const BodyPort&, std::span<const double>) {}
  /// Begins the random numbers of the body anew; counts from the next `Place` on.
  virtual void Seed(uint64_t) {}
  /// Returns what the body did that its model excludes, since it was asked last: `temperature leaves [60, 82]`.
  virtual std::vector<std::string> TakeBroken() { return {}; }

  /// Gives a parameter a value; it counts from the next `Place` on.
  void Set(const std::string& name, double value) { values_[name] = value; }
  /// Returns the value of a parameter, its default unless it was set. A name that the model does not list
  /// ends the program.
  double Value(std::string_view name) const;

 protected:
  /// Reads the parameters of the model, by `Value`.
  virtual void Prepare() = 0;
  /// Sets the state for a body at rest, and forgets what the controller remembers.
  virtual void Reset(const Point& position, double yaw) = 0;
  /// Sets the inputs for the next period of `dt` seconds, towards `target`. `last`: it is the end of the
  /// path.
  virtual void Control(const Point& target, bool last, double dt) = 0;
  /// Sets what the wheels do in the next period.
  virtual void Tell(const Twist&) {}
  /// Writes the derivative of the state `x` to `dx`, with the inputs held.
  virtual void Rate(std::span<const double> x, std::span<double> dx) const = 0;
  /// Lets `dt` seconds pass, with the inputs held: integrates `Rate`. Returns false as `Step` does.
  virtual bool Advance(double dt, Integrator integrator);
  /// Repairs the state after a step, such as the length of a quaternion.
  virtual void AfterStep() {}
  /// Tells the controller that the path is a new one.
  virtual void NewCommand() {}

  bool Pass(double dt, Integrator integrator);

  std::vector<double> state_;  ///< the first three are the position in metres, world frame

 private:
  std::map<std::string, double, std::less<>> values_;
  Waypoints way_;
};

/// Returns a new body of a model (`BodyModels` lists their names); nullptr for any other name.
std::unique_ptr<Body> MakeBody(std::string_view model);
/// Returns the names of all models, as fleet files have them.
std::vector<std::string> BodyModels();

}  // namespace rondo::sim
