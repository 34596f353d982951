#pragma once

#include "koord/node/node.h"
#include "transport/simulated/network.h"

/// Sensors where no world is simulated.
namespace rondo::sim::campaign {

/// Reads something else each time, of the type of the sensor: numbers from -10 to 10 or below 8. Lists and texts
/// stay as they are.
class Noise : public koord::node::Sensors {
 public:
  /// @param now  the time, which the values depend on; has to outlive this.
  Noise(const koord::semantics::Team& team, uint64_t seed, const transport::simulated::Time& now)
      : team_(team), seed_(seed), now_(now) {}

  void Read(size_t robot, uint64_t round, koord::node::Cell cell,
            std::span<koord::semantics::Word> words) override;

 private:
  const koord::semantics::Team& team_;
  uint64_t seed_;
  const transport::simulated::Time& now_;
};

}  // namespace rondo::sim::campaign
