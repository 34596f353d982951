#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <tuple>
#include <type_traits>

/// The values of programs that were made by `rondo build`.
namespace rondo::program {

/// Is a point, in metres.
struct Pos {
  double x = 0, y = 0, z = 0;

  static constexpr auto Members() { return std::tuple{&Pos::x, &Pos::y, &Pos::z}; }
};

/// Holds up to `kMost` items in itself. It costs what its items cost, not what it has room for.
template <typename T, uint32_t kMost>
class List {
 public:
  using Item = T;
  static constexpr uint32_t kCapacity = kMost;
  static constexpr bool kPlain = std::is_trivially_copyable_v<T>;
  static constexpr bool kSmall = kPlain && sizeof(T) * kMost <= 256;

  List() noexcept {}
  /// Takes at most `kMost` items; more are a mistake of whoever wrote the program.
  List(std::initializer_list<T> items) noexcept {
    for (const T& item : items) {
      if (size_ < kMost) Append(item);
    }
  }
  // What is small is copied as it is.
  List(const List& other) noexcept
    requires kSmall
  = default;
  List& operator=(const List& other) noexcept
    requires kSmall
  = default;
  ~List()
    requires kSmall
  = default;
  List(const List& other) noexcept { *this = other; }
  List& operator=(const List& other) noexcept {
    if (this == &other) return *this;
    if constexpr (kPlain) {
      for (size_t at = 0; at < other.size_ * sizeof(T); at += kBlock)
        std::memcpy(bytes_ + at, other.bytes_ + at, kBlock);
      size_ = other.size_;
      return *this;
    }
    const uint32_t both = std::min(size_, other.size_);
    std::copy_n(other.items_, both, items_);
    if (other.size_ > both) {
      std::uninitialized_copy_n(other.items_ + both, other.size_ - both, items_ + both);
    } else {
      std::destroy_n(items_ + both, size_ - both);
    }
    size_ = other.size_;
    return *this;
  }
  ~List() { std::destroy_n(items_, size_); }

  uint32_t size() const noexcept { return size_; }
  const T* begin() const noexcept { return items_; }
  const T* end() const noexcept { return items_ + size_; }
  T* begin() noexcept { return items_; }
  T* end() noexcept { return items_ + size_; }
  /// Returns an item; `index` must be below `size`.
  const T& operator[](uint64_t index) const noexcept { return items_[index]; }
  T& operator[](uint64_t index) noexcept { return items_[index]; }
  bool full() const noexcept { return size_ == kMost; }

  /// Appends an item, or puts it in front of the one at `index`. There must be room.
  void Append(const T& item) noexcept { std::construct_at(items_ + size_++, item); }
  void Insert(uint64_t index, const T& item) noexcept {
    const T copy = item;  // it may be one of this list
    Append(copy);
    for (uint64_t k = size_ - 1; k > index; --k) items_[k] = items_[k - 1];
    items_[index] = copy;
  }
  /// Takes away an item.
  void Drop(uint64_t index) noexcept {
    std::copy(items_ + index + 1, items_ + size_, items_ + index);
    std::destroy_at(items_ + --size_);
  }
  void Clear() noexcept {
    std::destroy_n(items_, size_);
    size_ = 0;
  }

  /// Exchanges what two lists hold, at the cost of the longer one.
  friend void swap(List& a, List& b) noexcept {
    if constexpr (kPlain) {
      std::byte block[kBlock];
      for (size_t at = 0; at < std::max(a.size_, b.size_) * sizeof(T); at += kBlock) {
        std::memcpy(block, a.bytes_ + at, kBlock);
        std::memcpy(a.bytes_ + at, b.bytes_ + at, kBlock);
        std::memcpy(b.bytes_ + at, block, kBlock);
      }
      std::swap(a.size_, b.size_);
    } else {
      const List before = a;
      a = b;
      b = before;
    }
  }

 private:
  // Plain bytes are copied in blocks of this size: without a call, and without asking how many are left.
  static constexpr size_t kBlock = 64;

  uint32_t size_ = 0;
  union {
    T items_[kMost];
    std::byte bytes_[(sizeof(T) * kMost + kBlock - 1) / kBlock * kBlock];
  };
};

/// Holds a text of up to `kMost` bytes.
template <uint32_t kMost>
struct Text : List<char, kMost> {
  Text() noexcept = default;
  explicit Text(std::string_view text) noexcept {
    for (const char c : text.substr(0, kMost)) this->Append(c);
  }
  std::string_view view() const noexcept { return {this->begin(), this->size()}; }
};

/// Holds a value of an external type as numbers that only external functions look into.
template <uint32_t kMost>
struct Opaque : List<uint64_t, kMost> {};

template <typename T>
inline constexpr bool kIsList = false;
template <typename T, uint32_t kMost>
inline constexpr bool kIsList<List<T, kMost>> = true;
template <uint32_t kMost>
inline constexpr bool kIsList<Text<kMost>> = true;
template <uint32_t kMost>
inline constexpr bool kIsList<Opaque<kMost>> = true;
template <typename T>
inline constexpr bool kIsArray = false;
template <typename T, size_t kLength>
inline constexpr bool kIsArray<std::array<T, kLength>> = true;
template <typename T>
concept Record = requires { T::Members(); };

/// Reports whether two values are the same. Numbers are compared bit by bit: all zeros have one sign.
template <typename T>
constexpr bool Same(const T& a, const T& b) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
  } else if constexpr (Record<T>) {
    return std::apply([&](auto... member) { return (Same(a.*member, b.*member) && ...); }, T::Members());
  } else if constexpr (kIsList<T> || kIsArray<T>) {
    if (a.size() != b.size()) return false;
    for (size_t k = 0; k < a.size(); ++k) {
      if (!Same(a[k], b[k])) return false;
    }
    return true;
  } else {
    return a == b;
  }
}

/// Returns how many items a list or an array has.
constexpr int64_t Len(const auto& items) noexcept { return static_cast<int64_t>(items.size()); }

/// Reports whether an item of a list or an array is this value.
constexpr bool Contains(const auto& items, const auto& value) noexcept {
  return std::any_of(items.begin(), items.end(), [&](const auto& item) { return Same(item, value); });
}

/// Gives every item of an array, or of arrays in arrays, this value.
template <typename Items, typename T>
void Fill(Items& items, const T& value) noexcept {
  for (auto& item : items) {
    if constexpr (kIsArray<std::remove_cvref_t<decltype(item)>>) {
      Fill(item, value);
    } else {
      item = value;
    }
  }
}

/// Reports whether a point lies in the box with these two corners.
constexpr bool InRect(const Pos& p, const Pos& low, const Pos& high) noexcept {
  return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
}

/// Returns the point with three equal coordinates.
constexpr Pos Splat(double value) noexcept { return {value, value, value}; }

/// Holds two operands: braces evaluate them from left to right, so that the first fault is the one that the program meets first.
template <typename T>
struct Two {
  T a, b;
};
template <typename T>
Two(T, T) -> Two<T>;

constexpr bool Less(const auto& two) noexcept { return two.a < two.b; }
constexpr bool LessEqual(const auto& two) noexcept { return two.a <= two.b; }

}  // namespace rondo::program
