// Any bytes: reading a fleet file, or a network file, ends, with values in their ranges or with located errors.
#include <cstdint>

#include "diag/render.h"
#include "sim/fleet/fleet.h"
#include "sim/network.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  const diag::FileId file = sources.Add("input", std::string(reinterpret_cast<const char*>(data), size));
  const sim::Fleet fleet = sim::ReadFleet(sources, file, diagnostics);
  sim::Fleet three;
  for (const char* name : {"r0", "r1", "r2"}) three.robots.emplace_back().name = name;
  const sim::NetworkFaults network = sim::ReadNetwork(sources, file, three, diagnostics);
  for (const sim::cores::Fault& fault : network.faults) {
    if (fault.robot > 2 || fault.other > 2 || fault.at < 0 || fault.length < 0) __builtin_trap();
  }
  size_t length = fleet.robots.size();
  for (const diag::Diagnostic& d : diagnostics.Sorted())
    length += diag::RenderText(sources, d, diag::Colour::kOff).size();
  return length == 1'000'000'007 ? 1 : 0;
}
