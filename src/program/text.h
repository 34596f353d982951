#pragma once

#include <charconv>
#include <cmath>
#include <string_view>

#include "program/values.h"

/// Writes values as text for people, as `rondo simulate` does.
namespace rondo::program {

/// Collects text in memory that was there before; what has no room is left out, and `whole` becomes false.
class Pen {
 public:
  Pen(char* begin, char* end) noexcept : at_(begin), end_(end) {}
  void Put(std::string_view text) noexcept {
    for (const char c : text) {
      if (at_ == end_) whole_ = false;
      if (at_ != end_) *at_++ = c;
    }
  }
  char* at() const noexcept { return at_; }
  bool whole() const noexcept { return whole_; }

 private:
  char* at_;
  char* end_;
  bool whole_ = true;
};

/// Writes a float in the shortest form that reads back as the same number: with an exponent beyond 1e16 and below 1e-4.
inline void ShowFloat(Pen& pen, double value) noexcept {
  char text[64];
  const double size = std::fabs(value);
  const bool fixed = size == 0 || (size >= 1e-4 && size < 1e16);
  const auto format = fixed ? std::chars_format::fixed : std::chars_format::scientific;
  const auto end = std::to_chars(text, text + sizeof text, value, format).ptr;
  pen.Put({text, static_cast<size_t>(end - text)});
}

/// Writes a value: `(1, 2, 0.5)`, `[a, b]`, `true`. Names of members are found by `NamesOf`, which the program defines.
template <typename T>
void Show(Pen& pen, const T& value) noexcept {
  if constexpr (std::is_same_v<T, bool>) {
    pen.Put(value ? "true" : "false");
  } else if constexpr (std::is_same_v<T, double>) {
    ShowFloat(pen, value);
  } else if constexpr (std::is_same_v<T, int64_t>) {
    char text[24];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    pen.Put({text, static_cast<size_t>(end - text)});
  } else if constexpr (std::is_enum_v<T>) {
    const auto names = NamesOf(value);
    const auto index = static_cast<size_t>(value);
    pen.Put(index < names.size() ? names[index] : "?");
  } else if constexpr (requires { value.view(); }) {
    pen.Put("\"");
    pen.Put(value.view());
    pen.Put("\"");
  } else if constexpr (Record<T>) {
    const char* separator = "(";
    std::apply(
        [&](auto... member) { ((pen.Put(separator), Show(pen, value.*member), separator = ", "), ...); },
        T::Members());
    pen.Put(")");
  } else {
    pen.Put("[");
    const char* separator = "";
    for (const auto& item : value) {
      pen.Put(separator);
      Show(pen, item);
      separator = ", ";
    }
    pen.Put("]");
  }
}

/// Writes a value as a line of its own: texts without quotes.
template <typename T>
void ShowPlain(Pen& pen, const T& value) noexcept {
  if constexpr (requires { value.view(); }) {
    pen.Put(value.view());
  } else {
    Show(pen, value);
  }
}

/// Holds what an event writes to streams: up to `kLines` lines that have up to `kBytes` bytes together.
template <uint32_t kLines, uint32_t kBytes>
class Lines {
 public:
  void Clear() noexcept { count_ = 0; }
  uint32_t size() const noexcept { return count_; }
  std::string_view operator[](uint32_t line) const noexcept {
    const uint32_t begin = line == 0 ? 0 : ends_[line - 1];
    return {text_ + begin, ends_[line] - begin};
  }
  /// Appends a line of these values. Returns false if there is no room for it.
  template <typename... T>
  bool Say(const T&... values) noexcept {
    if (count_ == kLines) return false;
    Pen pen(text_ + (count_ == 0 ? 0 : ends_[count_ - 1]), text_ + kBytes);
    (ShowPlain(pen, values), ...);
    if (!pen.whole()) return false;
    ends_[count_++] = static_cast<uint32_t>(pen.at() - text_);
    return true;
  }

 private:
  uint32_t count_ = 0;
  uint32_t ends_[kLines];
  char text_[kBytes];
};

}  // namespace rondo::program
