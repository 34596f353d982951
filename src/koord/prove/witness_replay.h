#pragma once

#include <string>

#include "koord/check/model.h"
#include "koord/prove/results.h"
#include "koord/semantics/machine/heap.h"

namespace rondo::koord {

enum class ReplayOutcome : uint8_t {
  kReplayed,     ///< the executable semantics makes the same round, and the invariant fails at its end
  kNotPossible,  ///< values or functions that cannot be executed
  kDiffers,      ///< a bug of ours
};
struct WitnessReplay {
  ReplayOutcome outcome = ReplayOutcome::kNotPossible;
  std::string why;
};

/// The words of a value; false if doubles and 64-bit ints cannot hold it exactly.
bool ToWords(const lang::TypeTable& types, TypeId type, const expr::Value& value,
             std::vector<semantics::Word>& words);

/// Executes the round of a counterexample: one real step of the program, independent of the solver and of the
/// symbolic execution that found it.
WitnessReplay ReplayWitness(const Model& model, size_t invariant, const WitnessState& witness);

}  // namespace rondo::koord
