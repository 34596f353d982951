#pragma once

#include <string>
#include <vector>

#include "choreo/graph/lowered_module_test.h"
#include "choreo/process/typing.h"
#include "choreo/project/project.h"
#include "choreo/semantics/team.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {

/// A choreography with all that is made of it.
struct Checked : LoweredModule {
  std::vector<LocalType> types;

  explicit Checked(const std::string& text) : LoweredModule(text) {
    if (graphs.empty()) return;
    CheckWellFormed(graphs[0], diagnostics);
    if (diagnostics.has_errors()) return;
    for (size_t r = 0; r < graphs[0].robots.size(); ++r)
      types.push_back(Project(graphs[0], module.exprs, RobotId(r), diagnostics));
  }
  bool good() const { return !graphs.empty() && !diagnostics.has_errors(); }
  Team team() const {
    std::vector<Machine> machines;
    for (const LocalType& t : types) machines.push_back(MachineOf(graphs[0], t));
    return Team(std::move(machines));
  }
};

inline std::string Join(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& p : parts) text += " " + p;
  return text;
}

}  // namespace rondo::choreo
