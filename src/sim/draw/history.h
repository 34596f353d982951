#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/bodies/body.h"
#include "trace/ros.h"

/// Reads traces of simulations for pictures and replays.
namespace rondo::sim {

/// Holds what a trace of a simulation tells, as far as pictures need it.
struct History {       // NOLINT(bugprone-exception-escape): moving JSON checks itself
  nlohmann::json run;  ///< the record `/rondo/run`
  struct Robot {
    std::string name;
    double radius = 0;                            ///< metres
    std::vector<std::pair<double, Point>> poses;  ///< time in seconds, position
  };
  std::vector<Robot> robots;
  struct Event {
    double time;
    nlohmann::json event;
  };
  std::vector<Event> events;
  trace::Grid map;                               ///< the last map of the trace; no cells if there is none
  std::vector<std::pair<double, size_t>> known;  ///< (seconds, known cells of the map then)
};

/// Returns the text that a record has under this key; empty if it has none.
std::string TextOf(const nlohmann::json& record, const char* key);

/// Returns what a picture of this run is called: program, robots, seed.
std::string TitleOf(const History& history);

/// Reads the bytes of a trace (MCAP).
/// @error if they are no trace of Rondo's simulator.
base::Result<History> ReadHistory(std::string_view bytes);

}  // namespace rondo::sim
