#include "explore/candidates.h"

namespace rondo::explore {

void Candidates::Grow(Share& share, size_t more) {
  constexpr size_t kFirst = 1024;
  share.capacity = std::max({kFirst, 2 * share.capacity, share.size + more});
  auto bytes = std::make_unique_for_overwrite<uint8_t[]>(share.capacity);
  std::copy_n(share.bytes.get(), share.size, bytes.get());
  share.bytes = std::move(bytes);
}

void Candidates::KeepFirst(uint32_t count) {
  for (size_t s = 0; s < kShares; ++s) {
    size_t kept = 0;
    uint32_t items = 0;
    for (size_t at = 0; at < size(s) && Read(s, at).order < count; ++items) kept = at;
    shares_[s].size = kept;
    shares_[s].count = items;
  }
  count_ = count;
}

}  // namespace rondo::explore
