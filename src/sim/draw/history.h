#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/bodies/body.h"
#include "trace/ros.h"

namespace rondo::sim {

/// What a trace of a simulation tells, as far as pictures need it.
struct History {       // NOLINT(bugprone-exception-escape): moving JSON checks itself
  nlohmann::json run;  ///< the record `/rondo/run`
  struct Robot {
    std::string name;
    double radius = 0;
    std::vector<std::pair<double, Point>> poses;  ///< time in seconds, position
  };
  std::vector<Robot> robots;
  struct Event {
    double time;
    nlohmann::json event;
  };
  std::vector<Event> events;
  trace::Grid map;                               ///< the last one; no cells if there is none
  std::vector<std::pair<double, size_t>> known;  ///< known cells of the map over time
};

/// The text that a record has under this key; empty if it has none.
std::string TextOf(const nlohmann::json& record, const char* key);

/// @error if the bytes are no trace of Rondo's simulator.
base::Result<History> ReadHistory(std::string_view bytes);

}  // namespace rondo::sim
