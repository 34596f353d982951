#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "sim/bodies/body.h"
#include "sim/world/world.h"

namespace rondo::sim {

enum class Policy : uint8_t {
  kFirst,       ///< the first enabled event in the text; robots in the order of their numbers
  kRandom,      ///< any enabled event; robots in any order
  kRoundRobin,  ///< events and robots take turns
};

struct FleetRobot {
  std::string name;
  std::string model;
  Point position{};
  double yaw = 0;
  std::map<std::string, double> parameters;
  diag::Span span;
};

struct Lidar {
  double range = 10;      ///< m
  int beams = 360;        ///< over the full turn
  double rate = 10;       ///< Hz
  double noise = 0;       ///< standard deviation, m
  double resolution = 0;  ///< m; 0: none
};

/// A value of the program that the fleet file gives.
struct FleetValue {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  nlohmann::json value;
  diag::Span span;
};

/// The robots, their world, and how a simulation runs. Lengths in metres, times in seconds, angles in
/// radians.
struct Fleet {
  double delta = 0.1;  ///< length of a round
  double duration = 60;
  double step = 0.01;     ///< period of the controllers, and of RK4
  double monitor = 0.05;  ///< time between checks of assumptions, invariants and collisions
  double pose_rate = 10;  ///< Hz, in the trace
  double skip = 0;        ///< probability that a robot skips a round
  Integrator integrator = Integrator::kRungeKutta4;
  Policy policy = Policy::kFirst;
  std::optional<uint64_t> seed;
  diag::Span until_span;
  std::string until;  ///< `mapped`, `stopped` or nothing
  World world;
  Lidar lidar;
  double clearance = 0.3;     ///< planned paths keep so far from obstacles, beside the robot's radius
  double path_clearance = 1;  ///< `pathIsClear`
  double cell = 1;            ///< of maps
  double map_range = 0;       ///< how far scans are drawn into maps; 0: the scanner's range
  std::vector<FleetRobot> robots;
  std::map<std::string, FleetValue> params;
  std::map<std::string, FleetValue> initial;
};

/// Reads a fleet file (TOML). Every mistake is a located diagnostic; the fleet is of use only without errors.
Fleet ReadFleet(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
