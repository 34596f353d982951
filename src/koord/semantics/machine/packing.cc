#include "koord/semantics/machine/packing.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace rondo::koord::semantics {

namespace {

constexpr size_t kLongest = 10;  // bytes of one word

// Seven bits in a byte, the last ones first.
uint8_t* WriteNumber(Word w, uint8_t* to) {
  for (; w >= 0x80; w >>= 7) *to++ = static_cast<uint8_t>(w | 0x80);
  *to++ = static_cast<uint8_t>(w);
  return to;
}

const uint8_t* ReadNumber(const uint8_t* from, Word& w) {
  w = *from & 0x7fu;
  for (unsigned shift = 7; (*from++ & 0x80u) != 0; shift += 7) w |= Word{*from & 0x7fu} << shift;
  return from;
}

// Ints near zero are small numbers, whatever their sign.
Word Fold(Word w) { return w << 1 ^ static_cast<Word>(ToInt(w) >> 63); }
Word Unfold(Word w) { return w >> 1 ^ (0 - (w & 1)); }

// A float: how many of its bytes follow, the first ones first; those behind them are zero.
uint8_t* WriteFloat(Word w, uint8_t* to) {
  const auto bytes = static_cast<size_t>(8 - std::countr_zero(w) / 8);
  *to++ = static_cast<uint8_t>(bytes);
  for (size_t i = 0; i < bytes; ++i, w <<= 8) *to++ = static_cast<uint8_t>(w >> 56);
  return to;
}

const uint8_t* ReadFloat(const uint8_t* from, Word& w) {
  const unsigned bytes = *from++;
  w = 0;
  for (unsigned i = 0; i < bytes; ++i) w |= Word{*from++} << (56 - 8 * i);
  return from;
}

}  // namespace

Packing::Packing(const Layout& layout, uint32_t flags, HandleExchange* exchange)
    : flags_(flags), exchange_(exchange) {
  CHECK(flags <= 8);
  uint32_t word = 0;
  const auto add = [&](const Layout::Slot& slot) {
    if (slot.kind == WordKind::kBool)
      bits_.push_back(word++);
    else
      fields_.push_back({slot, word++});
  };
  for (const Layout::Slot& slot : layout.shared_slots()) add(slot);
  for (size_t r = 0; r < layout.robots(); ++r) {
    for (const Layout::Slot& slot : layout.block_slots()) add(slot);
  }
  head_ = std::max<size_t>(1, (flags + bits_.size() + 7) / 8);
  packed_.resize(head_ + fields_.size() * kLongest);
}

std::span<const uint8_t> Packing::Pack(std::span<const Word> state, Word flags) {
  uint8_t* const head = packed_.data();
  std::fill_n(head, head_, uint8_t{0});
  head[0] = static_cast<uint8_t>(flags);
  uint32_t bit = flags_;
  for (const uint32_t word : bits_) {
    head[bit / 8] |= static_cast<uint8_t>(state[word] << bit % 8);
    ++bit;
  }
  uint8_t* to = head + head_;
  for (const Field& f : fields_) {
    const Word w = state[f.word];
    switch (f.slot.kind) {
      case WordKind::kBool:
        break;
      case WordKind::kEnum:
        *to++ = static_cast<uint8_t>(w);
        break;
      case WordKind::kInt:
        to = WriteNumber(Fold(w), to);
        break;
      case WordKind::kFloat:
        to = WriteFloat(w, to);
        break;
      case WordKind::kHandle:
        to = WriteNumber(exchange_ == nullptr ? w : exchange_->ToNumber(f.slot.type, w), to);
        break;
    }
  }
  return {head, static_cast<size_t>(to - head)};
}

void Packing::Unpack(std::span<const uint8_t> packed, std::span<Word> state, Word& flags) {
  flags = Flags(packed);
  uint32_t bit = flags_;
  for (const uint32_t word : bits_) {
    state[word] = packed[bit / 8] >> bit % 8 & 1u;
    ++bit;
  }
  const uint8_t* from = packed.data() + head_;
  for (const Field& f : fields_) {
    Word& w = state[f.word];
    switch (f.slot.kind) {
      case WordKind::kBool:
        break;
      case WordKind::kEnum:
        w = *from++;
        break;
      case WordKind::kInt:
        from = ReadNumber(from, w);
        w = Unfold(w);
        break;
      case WordKind::kFloat:
        from = ReadFloat(from, w);
        break;
      case WordKind::kHandle:
        from = ReadNumber(from, w);
        if (exchange_ != nullptr) w = exchange_->ToHandle(f.slot.type, w);
        break;
    }
  }
}

}  // namespace rondo::koord::semantics
