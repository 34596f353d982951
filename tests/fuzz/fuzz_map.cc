// Any bytes, up to the first zero as the description of an occupancy map and behind it as its image: reading ends, with walls
// inside the map or with a message.
#include <cmath>
#include <cstdint>

#include "sim/world/occupancy_map.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace rondo;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const size_t end = std::min(bytes.find('\0'), bytes.size());
  const auto map =
      sim::ReadOccupancyMap("map.yaml", [&](const std::string& path) -> base::Result<std::string> {
        return path == "map.yaml" ? bytes.substr(0, end) : bytes.substr(std::min(end + 1, bytes.size()));
      });
  if (!map.ok()) return map.error().message.empty() ? __builtin_trap(), 0 : 0;
  for (const sim::Rectangle& r : map.value().walls) {
    for (size_t i = 0; i < 2; ++i) {
      const double slack = 1e-9 * (std::abs(map.value().low[i]) + std::abs(map.value().high[i]));
      if (r.low[i] < map.value().low[i] - slack || r.high[i] > map.value().high[i] + slack ||
          r.low[i] > r.high[i])
        __builtin_trap();
    }
  }
  return 0;
}
