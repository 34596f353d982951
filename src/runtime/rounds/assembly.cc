#include "runtime/rounds/assembly.h"

#include <algorithm>

namespace rondo::runtime::rounds {

bool Assembly::Fits(const codec::Part& part) const {
  return has_.empty() || (part.count == has_.size() && part.sum == sum_);
}

bool Assembly::Add(const codec::Part& part) {
  if (complete_) return true;
  if (has_.empty()) {
    has_.resize(part.count);
    sum_ = part.sum;
  }
  if (!Fits(part) || has_[part.index]) return false;
  const size_t begin = size_t{part.index} * codec::kPart;
  whole_.resize(std::max(whole_.size(), begin + part.bytes.size()));
  std::ranges::copy(part.bytes, whole_.begin() + static_cast<ptrdiff_t>(begin));
  has_[part.index] = true;
  if (++count_ < has_.size()) return false;
  if (codec::Sum(whole_) != sum_) {
    Clear();
    return false;
  }
  complete_ = true;
  return true;
}

codec::Bytes& Assembly::Make() {
  Clear();
  complete_ = true;
  return whole_;
}

void Assembly::Clear() {
  whole_.clear();
  has_.clear();
  count_ = 0;
  sum_ = 0;
  complete_ = false;
}

void Assembly::Missing(uint32_t& from, uint64_t& window) const {
  from = 0;
  window = UINT64_MAX;
  while (from < has_.size() && has_[from]) ++from;
  for (uint32_t k = 0; k < 64 && from + k < has_.size(); ++k) {
    if (has_[from + k]) window &= ~(uint64_t{1} << k);
  }
}

}  // namespace rondo::runtime::rounds
