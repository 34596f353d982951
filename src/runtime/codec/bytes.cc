#include "runtime/codec/bytes.h"

#include <xxhash.h>

namespace rondo::runtime::codec {

void Writer::Number(uint64_t value) {
  while (value >= 0x80) {
    out_.push_back(static_cast<uint8_t>(value | 0x80));
    value >>= 7;
  }
  out_.push_back(static_cast<uint8_t>(value));
}

void Writer::Fixed(uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8) out_.push_back(static_cast<uint8_t>(value >> shift));
}

void Writer::Block(View bytes) {
  Number(bytes.size());
  out_.insert(out_.end(), bytes.begin(), bytes.end());
}

View Reader::Take(size_t count) {
  if (!ok_ || count > bytes_.size()) {
    ok_ = false;
    return {};
  }
  const View taken = bytes_.first(count);
  bytes_ = bytes_.subspan(count);
  return taken;
}

uint8_t Reader::Byte() {
  const View byte = Take(1);
  return byte.empty() ? 0 : byte[0];
}

uint64_t Reader::Number(uint64_t most) {
  uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const uint8_t byte = Byte();
    if (!ok_) return 0;
    const uint64_t group = byte & 0x7fU;
    // Nothing beyond 64 bits, and no empty group at the end.
    if ((shift == 63 && group > 1) || (shift > 0 && byte == 0)) break;
    value |= group << shift;
    if ((byte & 0x80U) != 0) continue;
    if (value > most) break;
    return value;
  }
  ok_ = false;
  return 0;
}

uint64_t Reader::Fixed() {
  uint64_t value = 0;
  const View bytes = Take(8);
  for (size_t i = 0; i < bytes.size(); ++i) value |= static_cast<uint64_t>(bytes[i]) << (8 * i);
  return value;
}

View Reader::Block(size_t most) { return Take(Number(most)); }

uint64_t Sum(View bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace rondo::runtime::codec
