#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/stop.h"
#include "dds/network.h"
#include "deploy/robot_log.h"
#include "koord/semantics/team.h"
#include "sim/fleet/fleet.h"

/// Runs programs on robots.
namespace rondo::deploy {

/// Says how one robot of a fleet runs.
struct RobotOptions {
  uint32_t robot = 0;
  dds::Network network;
  uint64_t seed = 1;
  uint64_t session = 0;  ///< the same for all robots; another one for each run
  double duration = 0;   ///< seconds from when the first round begins; 0: until it is stopped
  std::string log;       ///< the file of its log; empty: none
  std::string folder;    ///< where it keeps what has to survive a crash; empty: nowhere
  std::string program_name, program, spec, fleet;  ///< texts
  nlohmann::json files;                            ///< what the fleet refers to
  base::StopToken stop;
  /// Lets something else than the machine run the events of the team; empty: nothing. @error why not.
  std::function<base::Result<bool>(koord::semantics::Team& team)> attach;
  /// Receives what a person should know, now and then: on one line.
  std::function<void(const std::string&)> tell;
};

/// Names why a robot ended.
enum class RobotEnding : uint8_t {
  kTime,         ///< its time was over
  kInterrupted,  ///< somebody asked it to stop
  kStopped,      ///< every robot of the program stopped
  kHalted,       ///< it lost the others, and the fleet halts then
  kBroken,       ///< the round protocol found itself broken
};
/// Returns `time`, `interrupted`, `stopped`, `halted` or `broken`.
std::string_view Name(RobotEnding ending);

/// Tells what became of a robot.
struct RobotReport {
  RobotEnding ending = RobotEnding::kTime;
  uint64_t rounds = 0;                   ///< the latest that it knew to be final
  uint64_t fallbacks = 0;                ///< how often it fell back
  uint64_t blind = 0;                    ///< rounds that it skipped because of its sensors
  uint64_t late = 0;                     ///< orders that came too late to be sent
  uint64_t failed = 0;                   ///< rounds in which an operation of an event had no value
  std::string log;                       ///< the file of its log; another one than asked for if there was one
  double median = 0, p99 = 0, most = 0;  ///< seconds from what it said to the end of the round
  std::string broken;
};

/// Runs one robot until it ends. It waits for its sensors, then for the others. When it ends, it stays where it is.
/// Nothing of the world is awaited by the thread that runs the rounds. Reports what is wrong with the program or the fleet.
/// @error in words: the network cannot be used, a file cannot be written. Empty: it was reported.
base::Result<RobotReport> RunRobot(const koord::Model& model, const sim::Fleet& fleet,
                                   const RobotOptions& options, diag::Diagnostics& diagnostics);

/// Returns, in digits, what all robots of a fleet have in common: a sum of their texts and of what they begin with. Reports what
/// is wrong with the program or the fleet, and returns nothing then.
std::string AgreementOf(const koord::Model& model, const sim::Fleet& fleet, const RobotOptions& options,
                        diag::Diagnostics& diagnostics);

}  // namespace rondo::deploy
