// Any bytes: reading a trace, and drawing it, ends.
#include <cstdint>

#include "sim/draw/plots.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo::sim;
  const auto history = ReadHistory(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!history.ok()) return 0;
  const World world;
  const size_t length = DrawPaths(history.value(), world).size() +
                        DrawDistances(history.value(), world).size() + DrawMap(history.value(), world).size();
  return length == 1 ? 1 : 0;
}
