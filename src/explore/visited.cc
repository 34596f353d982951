#include "explore/visited.h"

#include <algorithm>

namespace rondo::explore {

Visited::Visited(bool compact) : fresh_(kShares) {
  for (size_t s = 0; s < kShares; ++s) tables_.emplace_back(static_cast<uint8_t>(s), compact);
}

void Visited::VisitShare(size_t share, size_t member, std::span<const Candidates> lists,
                         std::span<const StateId> parents, const std::function<int(size_t, State)>& check) {
  StateTable& table = tables_[share];
  std::vector<Fresh>& fresh = fresh_[share];
  fresh.clear();
  constexpr size_t kAhead = 8;
  for (size_t l = 0; l < lists.size(); ++l) {
    const Candidates& list = lists[l];
    size_t far = 0, near = 0;
    const auto prefetch = [&](bool states) {
      if (far < list.size(share)) table.Prefetch(list.Read(share, far).hash);
      if (states && near < list.size(share)) table.PrefetchState(list.Read(share, near).hash);
    };
    for (size_t i = 0; i < 2 * kAhead; ++i) prefetch(i >= kAhead);
    for (size_t at = 0; at < list.size(share);) {
      const Candidates::Item item = list.Read(share, at);
      prefetch(true);
      const auto id = table.Insert(item.state, item.hash, parents[item.source]);
      if (!id) continue;
      const uint32_t order = firsts_[l] + item.order;
      fresh.push_back({order, item.source, *id, check(member, item.state), item.state});
      places_[order] = static_cast<uint32_t>((fresh.size() - 1) * kShares + share + 1);
    }
  }
}

std::span<const Visited::Fresh> Visited::Visit(std::span<const Candidates> lists,
                                               std::span<const StateId> parents,
                                               const std::function<int(size_t, State)>& check,
                                               base::Crew& crew) {
  firsts_.clear();
  uint32_t all = 0;
  for (const Candidates& list : lists) {
    firsts_.push_back(all);
    all += list.count();
  }
  places_.assign(all, 0);
  in_order_.clear();
  const auto visit = [&](size_t member, size_t share) { VisitShare(share, member, lists, parents, check); };
  constexpr uint32_t kFew = 256;  // not worth waking anybody
  if (all < kFew) {
    for (size_t share = 0; share < kShares; ++share) visit(0, share);
  } else {
    crew.Run(kShares, visit);
  }
  for (const uint32_t place : places_) {
    if (place != 0) in_order_.push_back(fresh_[(place - 1) % kShares][(place - 1) / kShares]);
  }
  return in_order_;
}

bool Visited::full() const { return std::ranges::any_of(tables_, &StateTable::full); }

size_t Visited::bytes() const {
  size_t all = places_.capacity() * sizeof(uint32_t) + in_order_.capacity() * sizeof(Fresh);
  for (const StateTable& table : tables_) all += table.bytes();
  for (const std::vector<Fresh>& fresh : fresh_) all += fresh.capacity() * sizeof(Fresh);
  return all;
}

size_t Visited::BytesAfter(std::span<const Candidates> lists) const {
  size_t all = bytes();
  for (size_t s = 0; s < kShares; ++s) {
    size_t states = 0, size = 0;
    for (const Candidates& list : lists) {
      states += list.count(s);
      size += list.size(s);
    }
    all += tables_[s].BytesAfter(states, size) - tables_[s].bytes();
  }
  return all;
}

}  // namespace rondo::explore
