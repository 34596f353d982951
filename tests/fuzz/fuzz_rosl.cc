// Any bytes as a `.rosl` file, the program of a robot in a fixed choreography.
#include <cstdint>

#include "choreo/syntax/chor_parser.h"
#include "choreo/syntax/parser.h"
#include "choreo_all.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  choreo::Module module;
  const std::string world =
      std::string(kFuzzWorld) +
      "choreography F in W { C -> A: fold(1 m, p: number | p > 0) while C.x > 0 { C -> A: more()\n"
      "{ C: Go(), A: Idle() } C -> A: on() } C -> A: done() }\n";
  choreo::Parse(sources, sources.Add("world", world), module, diagnostics);
  choreo::ParseProgram(sources, sources.Add("input", std::string(reinterpret_cast<const char*>(data), size)),
                       "A", module, diagnostics);
  return CheckEverything(sources, module, diagnostics);
}
