#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "base/result.h"
#include "base/stop.h"
#include "choreo/node/cast.h"
#include "dds/network.h"
#include "deploy/choreography/player.h"
#include "runtime/sessions/member.h"

/// Runs choreographies on robots.
namespace rondo::deploy {

/// Says how one robot of a choreography runs.
struct PlayerOptions {
  choreo::RobotId robot;
  dds::Network network;
  std::string program;  ///< what topics of the session are called by: `/rondo/PROGRAM/...`
  uint64_t seed = 1;
  uint64_t session = 0;    ///< the same for all robots; another one for each run
  uint64_t agreement = 0;  ///< sum of what all robots must have in common
  double duration = 0;     ///< seconds from when the session begins; 0: until it is over
  double patience = 1;     ///< seconds without a sign of life of another robot
  double max_age = 0.5;    ///< seconds after which a robot is no longer where its sensors said
  Precision precision;
  std::string log;        ///< the file of its log; empty: none
  nlohmann::json record;  ///< of the choreography: what a log keeps of it
  base::StopToken stop;
  /// Receives what a person should know, now and then: on one line.
  std::function<void(const std::string&)> tell;
};

/// Tells what became of a robot of a choreography.
struct PlayerReport {
  runtime::sessions::Outcome outcome = runtime::sessions::Outcome::kLeft;
  std::string why;         ///< kFailed, kLost
  bool begun = false;      ///< the session began
  bool time_over = false;  ///< it left because its time was over
  double time = 0;         ///< seconds of the session
  uint64_t messages = 0, motions = 0;
  double missed = 0;      ///< by how much contracts were missed, at most, as its sensors tell (SI units)
  std::string missed_by;  ///< which motion missed it
  double late = 0;        ///< seconds by which motions took longer than they may, at most
  uint64_t broken = 0;    ///< motions that missed theirs by more than the tolerance
  std::string log;        ///< the file of its log; another one than asked for if there was one
};

/// Runs one robot until its session is over for it. It waits for its sensors, then for the others. When it ends, it stays where
/// it is.
/// @error if the network cannot be used, or a file not written.
base::Result<PlayerReport> RunPlayer(const choreo::Cast& cast, const PlayerOptions& options);

}  // namespace rondo::deploy
