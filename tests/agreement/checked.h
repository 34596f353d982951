#pragma once

#include <memory>
#include <string>
#include <vector>

#include "choreo/graph/lower.h"
#include "choreo/process/typing.h"
#include "choreo/project/project.h"
#include "choreo/semantics/team.h"
#include "choreo/syntax/parser.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {

/// A choreography with all that is made of it.
struct Checked {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  Module module;
  expr::Arena arena;
  std::unique_ptr<Declarations> declarations;
  std::vector<Graph> graphs;
  std::vector<LocalType> types;

  explicit Checked(const std::string& text) {
    Parse(sources, sources.Add("random", text), module, diagnostics);
    if (diagnostics.has_errors()) return;
    declarations = std::make_unique<Declarations>(module, arena, diagnostics);
    graphs = Lower(module, *declarations);
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
