#pragma once

#include <span>
#include <vector>

#include "koord/semantics/machine/heap.h"

namespace rondo::koord::semantics {

struct Effect;

/// Runs the events of a team in place of the machine.
class Native {
 public:
  Native() = default;
  Native(const Native&) = delete;
  Native& operator=(const Native&) = delete;
  virtual ~Native() = default;

  /// Puts what a robot can do in `state` into `effects`, as `ProgramTransition::Of` lists it.
  virtual void Find(std::span<const Word> state, size_t robot, std::vector<Effect>& effects) = 0;
  /// Does the same for its `init`.
  virtual void FindInit(std::span<const Word> state, size_t robot, std::vector<Effect>& effects) = 0;
  /// Does what `FallBack` says.
  virtual bool FallBack(std::span<Word> state, size_t robot) = 0;
};

}  // namespace rondo::koord::semantics
