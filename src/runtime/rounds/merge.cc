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

std::optional<Contribution> Decode(View bytes) {
  Reader reader(bytes);
  Contribution contribution;
  contribution.inputs = reader.Block(bytes.size());
  const size_t count = reader.Number(kMostAlternatives);
  for (size_t i = 0; i < count && reader.ok(); ++i) {
    Alternative a;
    a.event = static_cast<uint32_t>(reader.Number(UINT32_MAX));
    a.locks = reader.Number(1) != 0;
    a.effect = reader.Block(bytes.size());
    contribution.alternatives.push_back(a);
  }
  if (!reader.Complete()) return std::nullopt;
  return contribution;
}

std::vector<Turn> Merge(uint64_t round, std::span<const uint32_t> robots,
                        std::span<const Contribution> contributions) {
  std::vector<Turn> turns;
  turns.reserve(robots.size());
  std::vector<uint32_t> locked;
  for (size_t i = 0; i < robots.size(); ++i) {
    const size_t k = (round + i) % robots.size();
    Turn turn{robots[k], contributions[k].inputs, nullptr};
    for (const Alternative& a : contributions[k].alternatives) {
      if (a.locks && std::ranges::find(locked, a.event) != locked.end()) continue;
      if (a.locks) locked.push_back(a.event);
      turn.does = &a;
      break;
    }
    turns.push_back(turn);
  }
  return turns;
}

}  // namespace rondo::runtime::rounds
