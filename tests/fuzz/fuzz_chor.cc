// Any bytes as a `.chor` file about a fixed world.
#include <cstdint>

#include "choreo/syntax/chor_parser.h"
#include "choreo/syntax/parser.h"
#include "choreo_all.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  choreo::Module module;
  choreo::Parse(sources, sources.Add("world", kFuzzWorld), module, diagnostics);
  choreo::ParseEquations(sources,
                         sources.Add("input", std::string(reinterpret_cast<const char*>(data), size)), module,
                         diagnostics);
  return CheckEverything(sources, module, diagnostics);
}
