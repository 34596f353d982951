#pragma once

#include <string>
#include <utility>
#include <variant>

#include "base/check.h"

/// Values that may be missing because the world failed: the one channel for errors of files and processes.
namespace rondo::base {

/// Says why the world failed us: a file, a process, a time-out. Wrong input is a diagnostic instead, and a
/// bug of ours a CHECK.
struct Error {
  std::string message;
};

/// Holds a value, or the error that prevented it. Has to be looked at: ignoring one is a compiler warning.
/// `value()` stops the program if there is none.
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
