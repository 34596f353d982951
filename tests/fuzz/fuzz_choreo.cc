// Any bytes: reading, building graphs, checking and projecting ends.
#include <cstdint>

#include "choreo/graph/lower.h"
#include "choreo/project/project.h"
#include "choreo/syntax/parser.h"
#include "choreo/wellformed/wellformed.h"
#include "diag/render.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  choreo::Module module;
  expr::Arena arena;
  choreo::Parse(sources, sources.Add("input", std::string(reinterpret_cast<const char*>(data), size)), module,
                diagnostics);
  choreo::Declarations declarations(module, arena, diagnostics);
  for (const choreo::Graph& graph : choreo::Lower(module, declarations)) {
    choreo::CheckWellFormed(graph, diagnostics);
    for (size_t r = 0; r < graph.robots.size(); ++r)
      choreo::Project(graph, module.exprs, choreo::RobotId(r), diagnostics);
  }
  size_t length = 0;
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  return length == 1 ? 1 : 0;
}
