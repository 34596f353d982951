#include "explore/state_table.h"

#include <algorithm>
#include <cstring>

namespace rondo::explore {

namespace {

constexpr size_t kFirstSlots = 1024;
constexpr uint64_t kPlaceBits = 32;

// A state is written as its parent, its length in one to five bytes, and its bytes.
size_t WriteLength(size_t length, uint8_t* to) {
  size_t n = 0;
  for (; length >= 0x80; length >>= 7) to[n++] = static_cast<uint8_t>(length | 0x80);
  to[n++] = static_cast<uint8_t>(length);
  return n;
}

size_t ReadLength(const uint8_t*& from) {
  size_t length = 0;
  for (unsigned shift = 0;; shift += 7) {
    const uint8_t byte = *from++;
    length |= size_t{byte & 0x7fu} << shift;
    if ((byte & 0x80u) == 0) return length;
  }
}

}  // namespace

uint64_t HashOf(State state) {
  uint64_t h = 0x9e3779b97f4a7c15u * (2 * state.size() + 1);
  const auto mix = [&](uint64_t w) {
    h = (h ^ w) * 0xff51afd7ed558ccdu;
    h ^= h >> 29;
  };
  size_t i = 0;
  for (; i + 8 <= state.size(); i += 8) {
    uint64_t w;
    std::memcpy(&w, state.data() + i, 8);
    mix(w);
  }
  uint64_t rest = 0;
  for (unsigned shift = 0; i < state.size(); ++i, shift += 8) rest |= uint64_t{state[i]} << shift;
  mix(rest);
  h *= 0xc4ceb9fe1a85ec53u;
  return h ^ (h >> 32);
}

StateTable::StateTable(uint8_t share, bool compact)
    : share_(uint64_t{share} << kPlaceBits),
      compact_(compact),
      mask_(kFirstSlots - 1),
      tags_(std::make_unique<uint8_t[]>(kFirstSlots)),
      places_(std::make_unique_for_overwrite<uint32_t[]>(kFirstSlots)) {}

bool StateTable::Holds(uint32_t place, State state, uint64_t hash) const {
  const uint8_t* at = At(place) + kParent;
  if (compact_) return std::memcmp(at, &hash, sizeof hash) == 0;
  if (ReadLength(at) != state.size()) return false;
  // Most states are short.
  size_t i = 0;
  for (; i + 8 <= state.size(); i += 8) {
    if (std::memcmp(at + i, state.data() + i, 8) != 0) return false;
  }
  for (; i < state.size(); ++i) {
    if (at[i] != state[i]) return false;
  }
  return true;
}

uint32_t StateTable::Append(State state, uint64_t hash, StateId parent) {
  uint8_t header[kParent + 10];
  std::memcpy(header, &parent, kParent);
  const size_t begin = kParent + (compact_ ? 0 : WriteLength(state.size(), header + kParent));
  const size_t size = begin + (compact_ ? sizeof hash : state.size());
  if (blocks_.empty() || used_.back() + size > kBlock) {
    const size_t allocated = std::max(size, kBlock);  // a huge state has a block of its own
    blocks_.push_back(std::make_unique_for_overwrite<uint8_t[]>(allocated));
    used_.push_back(0);
    block_bytes_ += allocated;
  }
  const size_t place = (blocks_.size() - 1) * kBlock + used_.back();
  uint8_t* at = blocks_.back().get() + used_.back();
  std::memcpy(at, header, begin);
  if (compact_)
    std::memcpy(at + begin, &hash, sizeof hash);
  else
    std::copy(state.begin(), state.end(), at + begin);
  used_.back() += static_cast<uint32_t>(std::min(size, kBlock));
  ++count_;
  return static_cast<uint32_t>(place);
}

void StateTable::Place(uint64_t hash, uint32_t place) {
  size_t slot = hash & mask_;
  while (tags_[slot] != 0) slot = (slot + 1) & mask_;
  tags_[slot] = TagOf(hash);
  places_[slot] = place;
}

void StateTable::Grow() {
  mask_ = 2 * mask_ + 1;
  tags_.reset();
  places_.reset();
  tags_ = std::make_unique<uint8_t[]>(mask_ + 1);
  places_ = std::make_unique_for_overwrite<uint32_t[]>(mask_ + 1);
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const uint8_t* const begin = blocks_[b].get();
    for (const uint8_t* at = begin; at < begin + used_[b];) {
      const auto place = static_cast<uint32_t>(b * kBlock + static_cast<size_t>(at - begin));
      at += kParent;
      uint64_t hash;
      if (compact_) {
        std::memcpy(&hash, at, sizeof hash);
        at += sizeof hash;
      } else {
        const size_t length = ReadLength(at);
        hash = HashOf({at, length});
        at += length;
      }
      Place(hash, place);
    }
  }
}

std::optional<StateId> StateTable::Insert(State state, uint64_t hash, StateId parent) {
  if (Crowded(count_ + 1)) Grow();
  const uint8_t tag = TagOf(hash);
  size_t slot = hash & mask_;
  for (; tags_[slot] != 0; slot = (slot + 1) & mask_) {
    if (tags_[slot] == tag && Holds(places_[slot], state, hash)) return std::nullopt;
  }
  const uint32_t place = Append(state, hash, parent);
  tags_[slot] = tag;
  places_[slot] = place;
  return share_ | place;
}

StateId StateTable::Parent(StateId id) const {
  StateId parent = 0;
  std::memcpy(&parent, At(static_cast<uint32_t>(id)), kParent);
  return parent;
}

bool StateTable::Is(State state, StateId id) const {
  return Holds(static_cast<uint32_t>(id), state, compact_ ? HashOf(state) : 0);
}

size_t StateTable::BytesAfter(size_t states, size_t state_bytes) const {
  const size_t header = compact_ ? kParent + sizeof(uint64_t) : kParent + 2;
  const size_t more = states * header + (compact_ ? 0 : state_bytes);
  const size_t left = blocks_.empty() ? 0 : kBlock - used_.back();
  size_t all = bytes() + (more > left ? (more - left + kBlock - 1) / kBlock * kBlock : 0);
  // The old index is gone before the new one is filled.
  for (size_t slots = mask_ + 1; (count_ + states) * 10 > slots * 7; slots *= 2) all += slots * kSlot;
  return all;
}

}  // namespace rondo::explore
