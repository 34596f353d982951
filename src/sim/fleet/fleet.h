#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "diag/diagnostic.h"
#include "runtime/rounds/settings.h"
#include "sim/bodies/body.h"
#include "sim/fleet/ros_tables.h"
#include "sim/world/world.h"

/// Reads fleets: which robots a simulation has, where they are, and how it runs.
namespace rondo::sim {

/// Names how robots and events are chosen in each round.
enum class Policy : uint8_t {
  kFirst,       ///< the first enabled event in the text; robots in the order of their numbers
  kRandom,      ///< any enabled event; robots in any order
  kRoundRobin,  ///< events and robots take turns
};

/// Makes a body, at no place yet.
using BodyFactory = std::function<std::unique_ptr<Body>()>;

/// Is where the frame of a robot's own odometry lies in the frame of the fleet.
struct Origin {
  Point position{};
  double yaw = 0;
};

/// Describes one robot of the fleet.
struct FleetRobot {
  std::string name;
  std::string model;  ///< a built-in one; or a robot type of the file `from`
  std::string from;   ///< as the fleet file says it; empty: a built-in model
  Point position{};
  double yaw = 0;
  std::map<std::string, double> parameters;
  std::map<std::string, double>
      initial;          ///< of models in files: states, memory and inputs at the start, SI units
  std::string address;  ///< of the machine that it is, for `profile = "wifi"`; empty: not said
  std::string
      node_namespace;  ///< of its topics, without the `/` in front; its name, unless the fleet says otherwise
  std::optional<Origin> origin;  ///< of what it measures itself; nothing: `/tf` says where that is
  diag::Span span;
  BodyFactory make;
};

/// Provides what fleet files refer to.
struct FleetSurroundings {
  /// Returns the bytes of a file whose path is relative to the fleet file.
  ///
  /// @error says why it cannot be read.
  std::function<base::Result<std::string>(const std::string& path)> read;
  /// Returns what makes bodies of the robot type `model` of the file `from`; nothing, after a report.
  std::function<BodyFactory(const FleetRobot& robot)> model;
};

/// Describes the scanner that every robot carries.
struct Lidar {
  double range = 10;      ///< how far it sees, metres
  int beams = 360;        ///< how many rays a scan has, over the full turn
  double rate = 10;       ///< scans per second
  double noise = 0;       ///< the standard deviation of its distances, metres
  double resolution = 0;  ///< its distances are multiples of this, metres; 0: they are not rounded
  bool robots = false;    ///< it sees robots, too
};

/// Holds a value that the fleet file gives to a parameter or variable of the program.
struct FleetValue {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  nlohmann::json value;
  diag::Span span;
};

/// Names what ends a run before its time is over.
enum class Until : uint8_t {
  kTime,     ///< nothing but that every robot stopped, as for kStopped
  kMapped,   ///< the shared map is complete
  kStopped,  ///< every robot stopped
};

/// Says how the robots keep together over a network (docs/runtime.md). Times in seconds.
struct FleetRounds {
  runtime::rounds::OnLoss on_loss = runtime::rounds::OnLoss::kHalt;
  runtime::rounds::Exchange exchange = runtime::rounds::Exchange::kAllToAll;  ///< who tells whom
  bool disks = false;      ///< robots keep what they store and promise where a crash cannot reach it
  double lease = 0.5;      ///< how long a robot acts after what was answered last
  double stop_time = 0.1;  ///< from the end of a lease until its fallback has taken over
  double patience = 0.5;   ///< without progress for so long, a robot is given up
};

/// Holds the robots, their world, and how a simulation runs. Lengths in metres, times in seconds, angles in
/// radians.
struct Fleet {
  double delta = 0.1;  ///< the length of a round
  double duration = 60;
  double step = 0.01;     ///< the period of the controllers, and the step of RK4
  double monitor = 0.05;  ///< the time between checks of assumptions and invariants
  double pose_rate = 10;  ///< how many poses of each robot the trace gets per second
  double skip = 0;        ///< the probability that a robot skips a round in which no event is urgent
  Integrator integrator = Integrator::kRungeKutta4;
  Policy policy = Policy::kFirst;
  std::optional<uint64_t> seed;
  diag::Span until_span;
  Until until = Until::kTime;
  World world;
  Lidar lidar;
  double clearance = 0.3;      ///< planned paths keep so far from obstacles, beside the robot's radius
  bool around_robots = false;  ///< planned paths lead around where the others are
  double path_clearance = 1;   ///< `pathIsClear`
  double cell = 1;             ///< the side of the cells of maps
  double map_range = 0;        ///< how far scans are drawn into maps; 0: the scanner's range
  FleetRounds rounds;
  FleetRos ros;
  std::vector<FleetRobot> robots;
  std::map<std::string, FleetValue> params;
  std::map<std::string, FleetValue> initial;
  std::map<std::string, size_t> capacities;  ///< of lists in programs as C++: by type, and of all `others`
};

/// Returns how the robots of a fleet run their rounds; `self`, `incarnation`, `agreement` and `session` are to be set.
runtime::rounds::Settings SettingsOf(const Fleet& fleet);

/// Reads a fleet file (TOML). Reports every mistake where it stands; the fleet is of use only without errors.
/// @param surroundings  without its functions, references to other files are errors.
Fleet ReadFleet(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics,
                const FleetSurroundings& surroundings = {});

}  // namespace rondo::sim
