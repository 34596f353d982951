#pragma once

#include <sstream>
#include <string>

/// `CHECK(cond) << values` stops the program when an internal invariant is broken. Always on, for bugs of
/// ours only: wrong input is a diagnostic, a failing world is a `Result`, and ignorance is a `Verdict`.

namespace rondo::base {

/// Collects the message and aborts when it is destroyed.
class CheckFailure {
 public:
  CheckFailure(const char* condition, const char* file, int line);
  CheckFailure(const CheckFailure&) = delete;
  CheckFailure& operator=(const CheckFailure&) = delete;
  [[noreturn]] ~CheckFailure();

  /// Appends a value to the message, as a stream prints it.
  template <typename T>
  CheckFailure& operator<<(const T& value) {
    text_ << value;
    return *this;
  }

 private:
  std::ostringstream text_;
};

/// Swallows the stream so that both arms of the conditional in CHECK have type void.
struct CheckVoid {
  void operator&(const CheckFailure&) const {}
};

}  // namespace rondo::base

// Not in parentheses: the message is streamed into its end.
// NOLINTBEGIN(bugprone-macro-parentheses)
/// Does nothing if `condition` holds; else prints the condition, its place and what is streamed in, and
/// aborts. Not in parentheses: the message is streamed into its end.
#define CHECK(condition)             \
  (condition) ? static_cast<void>(0) \
              : ::rondo::base::CheckVoid() & ::rondo::base::CheckFailure(#condition, __FILE__, __LINE__)
// NOLINTEND(bugprone-macro-parentheses)
