#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "program/values.h"

/// Writes values as bytes and reads them, as robots send them to each other: equal values are equal bytes.
namespace rondo::program {

using Bytes = std::vector<uint8_t>;

/// Appends values to bytes.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& out) : out_(out) {}

  /// Writes a number in as few groups of seven bits as it needs, the lowest first.
  void Number(uint64_t value) {
    for (; value >= 0x80; value >>= 7) out_.push_back(static_cast<uint8_t>(value | 0x80));
    out_.push_back(static_cast<uint8_t>(value));
  }
  /// Writes eight bytes, the lowest first.
  void Fixed(uint64_t value) {
    for (int k = 0; k < 64; k += 8) out_.push_back(static_cast<uint8_t>(value >> k));
  }
  void Text(std::string_view text) {
    Number(text.size());
    out_.insert(out_.end(), text.begin(), text.end());
  }
  template <typename T>
  void Value(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      Fixed(std::bit_cast<uint64_t>(value));
    } else if constexpr (std::is_same_v<T, int64_t>) {
      Number((static_cast<uint64_t>(value) << 1) ^ static_cast<uint64_t>(value >> 63));
    } else if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>) {
      Number(static_cast<uint64_t>(value));
    } else if constexpr (requires { value.view(); }) {
      Text(value.view());
    } else if constexpr (Record<T>) {
      std::apply([&](auto... member) { (Value(value.*member), ...); }, T::Members());
    } else {
      Number(value.size());
      for (const auto& item : value) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(item)>, uint64_t>) {
          Fixed(item);
        } else {
          Value(item);
        }
      }
    }
  }

 private:
  Bytes& out_;
};

/// Reads what a `ByteWriter` wrote. The first thing that cannot be read, or that is no value of its type, or has no room, makes
/// everything from there on zero and `ok` false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool Complete() const { return ok_ && bytes_.empty(); }

  uint64_t Number(uint64_t most = UINT64_MAX) {
    uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const uint8_t byte = Byte();
      const uint64_t group = byte & 0x7f;
      if (shift > 63 || (shift == 63 && group > 1) || (byte == 0 && shift > 0)) ok_ = false;
      if (!ok_) return 0;
      value |= group << shift;
      if (byte < 0x80) break;
    }
    if (value > most) ok_ = false;
    return ok_ ? value : 0;
  }
  uint64_t Fixed() {
    uint64_t value = 0;
    for (int k = 0; k < 64; k += 8) value |= static_cast<uint64_t>(Byte()) << k;
    return ok_ ? value : 0;
  }
  template <typename T>
  void Value(T& value) {
    if constexpr (std::is_same_v<T, double>) {
      value = std::bit_cast<double>(Fixed());
    } else if constexpr (std::is_same_v<T, int64_t>) {
      const uint64_t number = Number();
      value = static_cast<int64_t>((number >> 1) ^ (~(number & 1) + 1));
    } else if constexpr (std::is_same_v<T, uint64_t>) {
      value = Fixed();
    } else if constexpr (std::is_same_v<T, bool>) {
      value = Number(1) != 0;
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(Number(NamesOf(T{}).size() - 1));
    } else if constexpr (Record<T>) {
      std::apply([&](auto... member) { (Value(value.*member), ...); }, T::Members());
    } else if constexpr (kIsArray<T>) {
      if (Number(value.size()) != value.size()) ok_ = false;
      for (auto& item : value) Value(item);
    } else {
      value.Clear();
      const uint64_t size = Number(T::kCapacity);
      for (uint64_t k = 0; k < size && ok_; ++k) {
        if constexpr (requires { value.view(); }) {
          value.Append(static_cast<char>(Byte()));
        } else {
          typename T::Item item{};
          Value(item);
          value.Append(item);
        }
      }
    }
  }

 private:
  uint8_t Byte() {
    if (bytes_.empty()) ok_ = false;
    if (!ok_) return 0;
    const uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

  std::span<const uint8_t> bytes_;
  bool ok_ = true;
};

}  // namespace rondo::program
