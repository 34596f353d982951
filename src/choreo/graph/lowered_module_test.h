#pragma once

#include <memory>
#include <string>
#include <vector>

#include "choreo/graph/lower.h"
#include "choreo/syntax/parser.h"

namespace rondo::choreo {

/// A text that was read, and the graphs of its choreographies; none if it could not be read.
struct LoweredModule {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  Module module;
  expr::Arena arena;
  std::unique_ptr<Declarations> declarations;
  std::vector<Graph> graphs;

  explicit LoweredModule(const std::string& text) {
    Parse(sources, sources.Add("text", text), module, diagnostics);
    if (diagnostics.has_errors()) return;
    declarations = std::make_unique<Declarations>(module, arena, diagnostics);
    graphs = Lower(module, *declarations);
  }

  std::vector<diag::Kind> kinds() const {
    std::vector<diag::Kind> kinds;
    for (const diag::Diagnostic& d : diagnostics.all()) kinds.push_back(d.kind);
    return kinds;
  }
  /// What was reported first, for messages of tests.
  std::string trouble() const { return diagnostics.all().empty() ? "" : diagnostics.all()[0].message; }
};

}  // namespace rondo::choreo
