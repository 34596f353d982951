#pragma once

#include <span>

#include "koord/semantics/machine/heap.h"

namespace rondo::koord::semantics {

/// What a program cannot know by itself: external functions, and where its streams go.
class Host {
 public:
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  virtual ~Host() = default;
  /// Computes external function `f` for a robot. `result` is zero on entry. false: it has no value there.
  virtual bool Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) = 0;
  /// `stream << value`: the value of log type `type`.
  virtual void Log(size_t robot, size_t type, std::span<const Word> value) = 0;
};

}  // namespace rondo::koord::semantics
