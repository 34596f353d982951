#pragma once

#include <string>
#include <utility>
#include <variant>

#include "base/check.h"

namespace rondo::base {

/// Why the world failed us: a file, a process, a time-out. Not for wrong input (diagnostics) or bugs (CHECK).
struct Error {
  std::string message;
};

/// A value, or the error that prevented it. Must be looked at.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit by design
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: implicit by design

  bool ok() const { return std::holds_alternative<T>(state_); }
  const T& value() const& {
    CHECK(ok()) << error().message;
    return std::get<T>(state_);
  }
  T&& value() && {
    CHECK(ok()) << error().message;
    return std::get<T>(std::move(state_));
  }
  const Error& error() const { return std::get<Error>(state_); }

 private:
  std::variant<T, Error> state_;
};

}  // namespace rondo::base
