#pragma once

#include <string>
#include <vector>

#include "base/check.h"
#include "choreo/draw/automaton.h"
#include "choreo/draw/chart.h"
#include "choreo/graph/lower.h"
#include "choreo/process/typing.h"
#include "choreo/project/project.h"
#include "choreo/wellformed/wellformed.h"
#include "diag/render.h"

/// Everything that is done with a module about robots that move, after it was read. Something to return, so
/// that nothing is optimised away.
inline int CheckEverything(const rondo::diag::SourceSet& sources, const rondo::choreo::Module& module,
                           rondo::diag::Diagnostics& diagnostics) {
  using namespace rondo;
  size_t length = 0;
  if (!diagnostics.has_errors()) {
    expr::Arena arena;
    choreo::Declarations declarations(module, arena, diagnostics);
    std::vector<choreo::Graph> graphs = choreo::Lower(module, declarations);
    std::vector<choreo::Typed> typed;
    for (choreo::Graph& graph : graphs) {
      length += choreo::DrawChart(graph, module.exprs).size();
      choreo::CheckWellFormed(graph, diagnostics);
      std::vector<choreo::LocalType> types;
      for (size_t r = 0; r < graph.robots.size(); ++r) {
        types.push_back(choreo::Project(graph, module.exprs, choreo::RobotId(r), diagnostics));
        length += choreo::DrawAutomaton(graph, module.exprs, types.back()).size();
      }
      typed.push_back({&graph, std::move(types)});
    }
    if (!diagnostics.has_errors()) length += choreo::CheckProcesses(module, typed, declarations).size();
  }
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  return length == 1 ? 1 : 0;
}

/// A world and a choreography for the files of the original tool.
inline constexpr const char* kFuzzWorld =
    "robot R { state x: length in [-5 m, 5 m] state th: angle\n"
    "  mount top = self * translate(x, 0, 0) * rotate_z(th)\n"
    "  motion Idle() interruptible [0, inf) {}\n"
    "  motion Go(d: length = 1 m, T = 2 s) noninterruptible [T, T] { modifies x post x == d } }\n"
    "world W { A: R C: R on A.top }\ncontract K { assume A.x > 0 }\n";
