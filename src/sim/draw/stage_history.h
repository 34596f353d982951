#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/result.h"

/// Reads traces of choreographies for pictures and replays.
namespace rondo::sim {

/// Holds what a trace of a choreography tells, as far as pictures need it. Times in seconds.
struct StageHistory {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  nlohmann::json run;  ///< the record `/rondo/run`
  std::vector<std::string> robots;
  struct Motion {
    size_t robot;
    std::string text;
    double from, to;
  };
  struct Message {
    double time;
    size_t from, to;
    std::string label;
  };
  struct Incident {
    double time;
    std::string what;
  };
  std::vector<Motion> motions;    ///< in the order in which they begin
  std::vector<Message> messages;  ///< in order
  std::vector<Incident> incidents;
  double end = 0;   ///< of the run
  std::string why;  ///< it ended: `sim::motions::Name(Curtain)`
  /// Holds the states of each robot, by name, in SI units, in the order of time.
  std::vector<std::vector<std::pair<double, std::map<std::string, double>>>> states;
};

/// Reads the bytes of a trace (MCAP).
/// @error if they are no trace of a choreography.
base::Result<StageHistory> ReadStageHistory(std::string_view bytes);

}  // namespace rondo::sim
