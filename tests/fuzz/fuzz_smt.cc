// Any bytes: reading a script ends, and what is read without errors can be asked.
#include <cstdint>

#include "diag/render.h"
#include "lang/smtlib/script.h"
#include "solve/icp/icp_solver.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  lang::smtlib::Script script;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  lang::smtlib::ReadScript(sources, file, script, diagnostics);
  size_t length = 0;
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  if (diagnostics.has_errors() || script.arena.size() > 2000) return length == 1 ? 1 : 0;
  solve::Query query{&script.arena, {}, script.variables};
  for (const auto& command : script.commands) {
    if (command.kind == lang::smtlib::Command::Kind::kAssert)
      query.assertions.push_back({command.terms[0], ""});
  }
  solve::icp::Options options;
  options.max_boxes = 64;
  solve::icp::IcpSolver(options).Check(query, {std::chrono::milliseconds(200), false}, {});
  return 0;
}
