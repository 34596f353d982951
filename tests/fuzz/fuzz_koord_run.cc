// Any bytes that are a program: compiling, exploring and telling a run end, and find nothing that checks
// forbid.
#include <cstdint>
#include <nlohmann/json.hpp>

#include "explore/search.h"
#include "koord/check/check.h"
#include "koord/semantics/story.h"
#include "koord/semantics/system.h"
#include "koord/syntax/parser.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program program;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  koord::Parse(sources, file, program, diagnostics);
  if (diagnostics.has_errors()) return 0;
  const koord::Model model = koord::Check(program, diagnostics);
  if (diagnostics.has_errors()) return 0;
  const auto team = koord::semantics::Team::Make(model, {2, {}, {}, {}}, diagnostics);
  if (team == nullptr || diagnostics.has_errors()) return 0;
  koord::semantics::System system(*team, {}, diagnostics);
  if (diagnostics.has_errors()) return 0;
  explore::SearchOptions options;
  options.states = 300;
  options.depth = 6;
  const explore::SearchResult result = explore::Search(system, options);
  if (result.ending != explore::Ending::kBroken) return 0;
  const auto run = system.Explain(result.path, result.broken);
  return koord::semantics::Tell(*team, run).size() + koord::semantics::RunToJson(*team, run).size() == 1 ? 1
                                                                                                         : 0;
}
