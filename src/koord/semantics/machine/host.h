#pragma once

#include <span>

#include "koord/semantics/machine/heap.h"

/// Connects the machine with what surrounds a program.
namespace rondo::koord::semantics {

/// Says what came of a call of an external function.
enum class Answer : uint8_t {
  kValue,
  kNone,   ///< the function has no value there: `Fault::kExternal`
  kLater,  ///< it is not finished: `Fault::kNotYet`; not for `init`, which nothing goes on without
};

/// Provides what a program cannot compute by itself: external functions, and a place for what it writes to
/// streams.
class Host {
 public:
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  virtual ~Host() = default;
  /// Computes external function `f` for a robot. `result` has the words of its type, zero on entry.
  virtual Answer Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) = 0;
  /// Receives what a robot writes by `stream << value`; the value is of log type `type` (`Team::ShowLogged`).
  virtual void Log(size_t robot, size_t type, std::span<const Word> value) = 0;
};

}  // namespace rondo::koord::semantics
