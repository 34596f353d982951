#include "runtime/rounds/merge.h"

#include <algorithm>

namespace rondo::runtime::rounds {

using codec::Reader;
using codec::Writer;

void Encode(const Contribution& contribution, Bytes& out) {
  Writer writer(out);
  writer.Block(contribution.inputs);
  writer.Number(contribution.alternatives.size());
  for (const Alternative& a : contribution.alternatives) {
    writer.Number(a.event);
    writer.Byte(a.locks ? 1 : 0);
    writer.Block(a.effect);
  }
}

bool Decode(View bytes, Contribution& contribution) {
  Reader reader(bytes);
  contribution.inputs = reader.Block(bytes.size());
  contribution.alternatives.clear();
  const size_t count = reader.Number(kMostAlternatives);
  for (size_t i = 0; i < count && reader.ok(); ++i) {
    Alternative a;
    a.event = static_cast<uint32_t>(reader.Number(UINT32_MAX));
    a.locks = reader.Number(1) != 0;
    a.effect = reader.Block(bytes.size());
    contribution.alternatives.push_back(a);
  }
  return reader.Complete();
}

void Merge(uint64_t round, const Locks& locks, std::span<const uint32_t> robots,
           std::span<const Contribution> contributions, std::vector<Turn>& turns) {
  turns.clear();
  for (size_t i = 0; i < robots.size(); ++i) {
    const size_t k = locks.Who(round, i, robots.size());
    const auto taken = [&](uint32_t event) {
      return std::ranges::any_of(turns, [&](const Turn& other) {
        return other.does != nullptr && other.does->locks && other.does->event == event;
      });
    };
    Turn turn{robots[k], contributions[k].inputs, nullptr};
    for (const Alternative& a : contributions[k].alternatives) {
      if (a.locks && taken(a.event)) continue;
      turn.does = &a;
      break;
    }
    turns.push_back(turn);
  }
}

}  // namespace rondo::runtime::rounds
