#include "sim/choice.h"

#include <random>

#include "base/mixed.h"
#include "base/uniform.h"

namespace rondo::sim {

using koord::semantics::Effect;

size_t Choose(const Fleet& fleet, uint64_t seed, uint64_t round, size_t robot,
              std::span<const Effect> effects) {
  std::mt19937_64 random(base::Mixed(seed ^ base::Mixed(round * 1024 + robot)));
  if (round > 0 && !effects[0].urgent && fleet.skip > 0 && base::Uniform(random) < fleet.skip)
    return effects.size();
  std::vector<size_t> firsts;  // of the events
  for (size_t i = 0; i < effects.size(); ++i) {
    if (i == 0 || effects[i].event != effects[i - 1].event) firsts.push_back(i);
  }
  const size_t k = fleet.policy == Policy::kFirst    ? 0
                   : fleet.policy == Policy::kRandom ? random() % firsts.size()
                                                     : (round + robot) % firsts.size();
  const size_t end = k + 1 < firsts.size() ? firsts[k + 1] : effects.size();
  return firsts[k] + random() % (end - firsts[k]);
}

}  // namespace rondo::sim
