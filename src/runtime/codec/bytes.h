#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Encodes what robots send to each other and keep on disk: each value in exactly one way, so that equal
/// values are equal bytes, and with every length bounded before memory is taken for it.
namespace rondo::runtime::codec {

using Bytes = std::vector<uint8_t>;
using View = std::span<const uint8_t>;

/// Appends values to bytes.
class Writer {
 public:
  explicit Writer(Bytes& out) : out_(out) {}

  void Byte(uint8_t value) { out_.push_back(value); }
  /// Writes a number in as few groups of seven bits as it needs, the lowest first.
  void Number(uint64_t value);
  /// Writes eight bytes, the lowest first.
  void Fixed(uint64_t value);
  /// Writes the length and the bytes.
  void Block(View bytes);

 private:
  Bytes& out_;
};

/// Reads what a `Writer` wrote. The first thing that cannot be read, or that a `Writer` would have written in
/// another way, makes everything from there on zero and `ok` false.
class Reader {
 public:
  explicit Reader(View bytes) : bytes_(bytes) {}

  uint8_t Byte();
  /// Reads a number of at most `most`.
  uint64_t Number(uint64_t most = UINT64_MAX);
  uint64_t Fixed();
  /// Reads at most `most` bytes; they stay where they are.
  View Block(size_t most);
  /// Says that what was read makes no sense.
  void Fail() { ok_ = false; }

  bool ok() const { return ok_; }
  /// Reports whether everything was read, and could be.
  bool Complete() const { return ok_ && bytes_.empty(); }

 private:
  View Take(size_t count);

  View bytes_;
  bool ok_ = true;
};

/// Returns a number for these bytes that differs for different ones, but for one pair in 2^64 (XXH3). It is
/// no protection against somebody who wants two to be equal.
uint64_t Sum(View bytes);

}  // namespace rondo::runtime::codec
