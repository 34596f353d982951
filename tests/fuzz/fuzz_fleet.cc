// Any bytes: reading a fleet file ends, with a fleet that has values in their ranges or with located errors.
#include <cstdint>

#include "diag/render.h"
#include "sim/fleet/fleet.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  const sim::Fleet fleet = sim::ReadFleet(sources, file, diagnostics);
  size_t length = fleet.robots.size();
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  return length == 1'000'000'007 ? 1 : 0;
}
