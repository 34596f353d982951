#pragma once

#include <string>
#include <vector>

#include "choreo/node/cast.h"
#include "deploy/choreography/session_log.h"

namespace rondo::deploy {

/// Tells what logs of a choreography show.
struct SessionsReport {
  uint64_t messages = 0, motions = 0;
  std::vector<std::string> findings;  ///< what is not as the choreography says
  std::vector<std::string> gaps;      ///< what cannot be judged: logs that end early, or are not there
  struct Miss {
    std::string robot, motion;
    double missed = 0;
  };
  std::vector<Miss>
      broken;       ///< motions that missed their contracts by more than the tolerance of their robots
  Miss worst;       ///< of all
  double late = 0;  ///< seconds by which motions took longer than they may, at most
  struct End {
    std::string robot, outcome;  ///< `runtime::sessions::Name(Outcome)`
    std::string why;
  };
  std::vector<End> ends;  ///< of those that left before they were at their ends
};

/// Judges the logs of the robots of a choreography by its local types: each message is taken once, in the order in which it was sent,
/// by whom it is for, and is one that sender and receiver may exchange then. Needs no common clock: what a robot did is in order,
/// and a message joins two robots. Shares nothing with the session protocol.
/// @error if the logs are not of one run.
base::Result<SessionsReport> JudgeSessions(const std::vector<SessionLog>& logs, const choreo::Cast& cast);

}  // namespace rondo::deploy
