#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "koord/check/model.h"
#include "sim/fleet/fleet.h"
#include "trace/writer.h"

/// Simulates Koord programs on fleets of robots.
namespace rondo::sim {

struct NetworkFaults;

/// Says how a simulation runs, beside what the fleet says.
struct SimulationOptions {
  uint64_t seed = 1;
  double duration = 0;  ///< seconds; 0: as the fleet says
  unsigned jobs = 0;    ///< threads; 0: one for each core. The result does not depend on it
  /// Holds what the trace keeps about where the run came from: texts of program, specification and fleet.
  std::string program, spec, fleet, program_name;
  nlohmann::json files;  ///< what the fleet refers to; null if it refers to nothing
  /// Lets the robots agree on their rounds over this network, by the cores that robots run; nullptr: they
  /// share one store. `network_text` is the file that it comes from.
  const NetworkFaults* network = nullptr;
  std::string network_text;
  /// Receives, after each round, how far the run is, in seconds.
  std::function<void(double time, double end)> progress;
  base::StopToken stop;
};

/// Tells why a simulation ended.
enum class Ending : uint8_t {
  kTime,         ///< its time was over
  kStopped,      ///< every robot stopped, and no body moves
  kQuiet,        ///< nothing moves any more, and no event can run
  kMapped,       ///< the map is complete
  kInterrupted,  ///< somebody asked it to stop
  kFailed,       ///< an operation of the program has no value, or the state of a body is not finite
};

/// Returns `time`, `stopped`, `quiet`, `mapped`, `interrupted` or `failed`, as traces and JSON have it.
std::string_view Name(Ending ending);

/// Tells something that must not happen, and did, how often it was seen, and when first.
struct Violation {
  std::string what;  ///< `assumption Motion.stays_in_box`, `invariant geofence`, `summary merge`
  int robot = -1;
  double first = 0;  ///< seconds
  uint64_t count = 0;
};

/// Tells something that happened to the team of a simulated network.
struct Happening {
  double time = 0;  ///< seconds
  int robot = -1;   ///< -1: to all
  std::string what;
};

/// Tells what the robots of a simulation did over their network.
struct NetworkReport {
  uint64_t datagrams = 0;  ///< sent, each receiver counted
  uint64_t bytes = 0;
  uint64_t epochs = 0;
  uint64_t fallbacks = 0;     ///< how often a lease ended
  std::vector<double> waits;  ///< seconds from what a robot said to the end of its round, in increasing order
  std::vector<Happening> happenings;
};

/// Holds what happened in a simulation.
struct SimulationReport {
  bool ran = false;  ///< false: the program cannot be simulated, which was reported
  double time = 0;   ///< seconds simulated
  uint64_t rounds = 0;
  uint64_t events = 0;
  double observed_every = 0;  ///< seconds between looks at contacts and distances
  uint64_t collisions = 0;    ///< how often a contact began
  double first_collision = -1;
  std::string first_pair;
  /// Gives the least distances of the run, in metres between surfaces; infinite if there is nothing, or
  /// (beyond 200 robots) if it is not measured.
  double least_between_robots = std::numeric_limits<double>::infinity();
  double least_to_obstacles = std::numeric_limits<double>::infinity();
  std::vector<Violation> violations;
  std::vector<std::string> unchecked;  ///< parts of the specification that runs are not checked against
  Ending ended = Ending::kTime;
  uint64_t plans = 0;
  uint64_t known_cells = 0;  ///< of the shared map, if there is one: cells that are not unknown
  uint64_t wrong_cells = 0;
  uint64_t reachable_unknown = 0;
  std::optional<NetworkReport> network;  ///< if there was one
  std::vector<std::string> log;          ///< what robots wrote to streams: the last lines
};

/// Runs a Koord program on a simulated fleet, in virtual time. Everything that happens is written to the
/// trace, if there is one. The same program, fleet and seed give the same run, byte by byte, whatever the
/// number of threads.
SimulationReport Simulate(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options,
                          trace::Writer* trace, diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
