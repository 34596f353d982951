#pragma once

#include <memory>

#include "choreo/graph/graph.h"
#include "driver/load.h"

namespace rondo::driver {

/// A `.rondo` file that was read, and the graphs of its choreographies.
struct Motion {
  choreo::Module module;
  std::vector<choreo::Graph> graphs;
};

/// Reads a file and builds its graphs; nothing after a message when it cannot be read. What is wrong is in
/// `session.diagnostics`.
std::unique_ptr<Motion> LoadMotion(const std::string& file, Session& session);

/// Everything that can be said of a file without a solver: names, well-formedness, projections. False if it
/// cannot be read.
bool CheckMotion(const std::string& file, Session& session);

}  // namespace rondo::driver
