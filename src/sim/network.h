#pragma once

#include <vector>

#include "diag/diagnostic.h"
#include "sim/cores/fault.h"
#include "sim/fleet/fleet.h"
#include "transport/simulated/network.h"

/// The network of a simulated fleet, as a file says it.
namespace rondo::sim {

/// Says what becomes of datagrams, and what goes wrong when.
struct NetworkFaults {
  transport::simulated::Conditions conditions;
  std::vector<cores::Fault> faults;
};

/// Reads a network file (TOML; docs/simulation.md, "Networks"). Every mistake is reported where it stands; the
/// result is of use only without errors.
NetworkFaults ReadNetwork(const diag::SourceSet& sources, diag::FileId file, const Fleet& fleet,
                          diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
