#pragma once

#include <algorithm>

#include "runtime/codec/messages.h"

/// Puts together what travels in parts.
namespace rondo::runtime::rounds {

/// Collects the parts of one frame or store. Parts that do not belong to the same whole are refused; a whole
/// whose sum is wrong is forgotten.
class Assembly {
 public:
  /// Returns true if the whole is complete, now or since before.
  bool Add(const codec::Part& part);
  /// Reports whether the part belongs to the same whole as those that came before.
  bool Fits(const codec::Part& part) const;
  /// Says that the whole is made here: it is what is put into the bytes, which are empty at first.
  codec::Bytes& Make();
  /// Forgets everything but the memory.
  void Clear();

  bool complete() const { return complete_; }
  const codec::Bytes& whole() const { return whole_; }
  /// Returns the first part that is missing, and which of the 64 from there on are.
  void Missing(uint32_t& from, uint64_t& window) const;
  /// Appends everything that it is (`Core::Describe`).
  void Describe(codec::Writer& writer) const;

 private:
  codec::Bytes whole_;
  std::vector<bool> has_;
  size_t count_ = 0;  // parts that came
  uint64_t sum_ = 0;
  bool complete_ = false;
};

/// Calls `send` with each part of a whole that the window asks for.
/// @param of  of a frame, whose it is.
template <typename Send>
void ForParts(codec::What what, codec::Place at, std::optional<codec::Member> of, const codec::Bytes& whole,
              uint32_t from, uint64_t window, const Send& send) {
  const auto count =
      static_cast<uint32_t>(std::max<size_t>(1, (whole.size() + codec::kPart - 1) / codec::kPart));
  const uint64_t sum = codec::Sum(whole);
  for (uint32_t k = 0; k < 64 && from + k < count; ++k) {
    if ((window >> k & 1) == 0) continue;
    const size_t begin = size_t{from + k} * codec::kPart;
    const auto part = codec::View(whole).subspan(begin, std::min(codec::kPart, whole.size() - begin));
    send(codec::Part{what, at, of, sum, from + k, count, part});
  }
}

}  // namespace rondo::runtime::rounds
