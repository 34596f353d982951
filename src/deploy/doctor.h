#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/stop.h"
#include "dds/network.h"
#include "deploy/status.h"
#include "koord/check/model.h"
#include "sim/fleet/fleet.h"

/// Finds out why a fleet does not run as it should.
namespace rondo::deploy {

/// Is something that is not as it should be, and what to do about it.
struct Trouble {
  bool wrong = true;  ///< else it is worth knowing
  std::string of;     ///< of which robot; empty: of all, or of this machine
  std::string what;
  std::string help;
};

/// Is the way from here to a robot, measured with questions that it answers at once.
struct WayTo {
  std::string robot;
  size_t asked = 0, answered = 0;
  double median = 0, most = 0;  ///< seconds, there and back
  double ahead = 0;             ///< seconds by which the clock on its wall is ahead of the one here
};

/// Holds what was found.
struct Health {
  std::vector<RobotStatus> robots;  ///< those that were heard
  std::vector<WayTo> ways;          ///< to those
  std::vector<Trouble> troubles;
  bool healthy() const;
};

/// Listens to a fleet for so many seconds, and asks its robots.
/// @param agreement  what all robots have to have in common (`AgreementOf`), in digits.
/// @error in the words of the library if the network cannot be used.
base::Result<Health> Examine(const koord::Model& model, const sim::Fleet& fleet, const dds::Network& network,
                             const std::string& agreement, double seconds, const base::StopToken& stop,
                             diag::Diagnostics& diagnostics);

/// Returns what is missing on this machine for robots to run well on it.
std::vector<Trouble> ExamineMachine(const dds::Network& network);

}  // namespace rondo::deploy
