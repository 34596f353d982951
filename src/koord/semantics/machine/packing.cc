#include "koord/semantics/machine/packing.h"

#include <algorithm>

#include "base/check.h"

namespace rondo::koord::semantics {

namespace {

// Ints from -2^30 up to 2^30 stand for themselves, other patterns for numbered ones.
constexpr int64_t kInline = int64_t{1} << 30;

uint32_t Bits(WordKind kind) {
  switch (kind) {
    case WordKind::kBool:
      return 1;
    case WordKind::kEnum:
      return 8;
    case WordKind::kInt:
    case WordKind::kFloat:
    case WordKind::kHandle:
      break;
  }
  return 32;
}

}  // namespace

Packing::Packing(const Layout& layout, uint32_t flags) : flags_(flags) {
  uint32_t used = flags;
  const auto add = [&](WordKind kind) {
    const uint32_t bits = Bits(kind);
    if (used % 64 + bits > 64) used = (used / 64 + 1) * 64;
    fields_.push_back({kind, static_cast<uint8_t>(used % 64), used / 64});
    used += bits;
  };
  for (const WordKind kind : layout.shared_kinds()) add(kind);
  for (size_t r = 0; r < layout.robots(); ++r) {
    for (const WordKind kind : layout.block_kinds()) add(kind);
  }
  words_ = std::max<size_t>(1, (used + 63) / 64);
}

Word Packing::Number(Word value) {
  const auto [it, fresh] = number_.try_emplace(value, static_cast<uint32_t>(numbered_.size()));
  if (fresh) {
    CHECK(numbered_.size() < (size_t{1} << 31)) << "too many different numbers";
    numbered_.push_back(value);
  }
  return it->second;
}

void Packing::Pack(std::span<const Word> state, Word flags, std::span<Word> packed) {
  std::fill(packed.begin(), packed.end(), 0);
  packed[0] = flags;
  for (size_t i = 0; i < fields_.size(); ++i) {
    const Field& f = fields_[i];
    Word w = state[i];
    switch (f.kind) {
      case WordKind::kBool:
      case WordKind::kEnum:
      case WordKind::kHandle:
        break;
      case WordKind::kInt: {
        const int64_t value = ToInt(w);
        const bool small = value >= -kInline && value < kInline;
        w = small ? static_cast<Word>(value + kInline) : (Word{1} << 31) + Number(w);
        break;
      }
      case WordKind::kFloat:
        w = w == 0 ? 0 : Number(w) + 1;
        break;
    }
    packed[f.word] |= w << f.shift;
  }
}

void Packing::Unpack(std::span<const Word> packed, std::span<Word> state, Word& flags) const {
  flags = packed[0] & ((Word{1} << flags_) - 1);
  for (size_t i = 0; i < fields_.size(); ++i) {
    const Field& f = fields_[i];
    const Word w = packed[f.word] >> f.shift;
    switch (f.kind) {
      case WordKind::kBool:
        state[i] = w & 1;
        break;
      case WordKind::kEnum:
        state[i] = w & 0xff;
        break;
      case WordKind::kHandle:
        state[i] = w & 0xffffffffu;
        break;
      case WordKind::kInt: {
        const Word low = w & 0xffffffffu;
        state[i] = low < (Word{1} << 31) ? FromInt(static_cast<int64_t>(low) - kInline)
                                         : numbered_[low - (Word{1} << 31)];
        break;
      }
      case WordKind::kFloat: {
        const Word low = w & 0xffffffffu;
        state[i] = low == 0 ? 0 : numbered_[low - 1];
        break;
      }
    }
  }
}

}  // namespace rondo::koord::semantics
