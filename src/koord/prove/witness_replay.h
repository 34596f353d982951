#pragma once

#include <string>
#include <vector>

#include "koord/check/model.h"
#include "koord/prove/results.h"
#include "koord/semantics/machine/heap.h"

/// Confirms counterexamples of the prover by running them.
namespace rondo::koord {

/// Names what became of the replay of a counterexample.
enum class ReplayOutcome : uint8_t {
  kReplayed,     ///< the executable semantics makes the same round, and the invariant fails at its end
  kNotPossible,  ///< it has values or functions that cannot be executed
  kDiffers,      ///< the semantics does not make this round or does not break the invariant: a bug of ours
};
/// Tells what became of a replay, and why if it was not replayed.
struct WitnessReplay {
  ReplayOutcome outcome = ReplayOutcome::kNotPossible;
  std::string why;
};

/// Appends the words of a value. Returns false if doubles and 64-bit ints cannot hold it exactly.
bool ToWords(const lang::TypeTable& types, TypeId type, const expr::Value& value,
             std::vector<semantics::Word>& words);

/// Executes the round of a counterexample as one real step of the program, independent of the solver and of
/// the symbolic execution that found it. Its start must satisfy the invariants, a choice of the robots must
/// lead to its end, the environment must keep the assumptions, and the invariant must fail.
WitnessReplay ReplayWitness(const Model& model, size_t invariant, const WitnessState& witness);

/// Returns, by invariant, whether it holds where a counterexample starts, as far as its values can be those of a run:
/// others, such as lists, are taken for zero. Empty if the program cannot be executed. A hint, and no evidence.
/// @param model  has the variables of the program that the counterexample is of, and may have more invariants.
std::vector<bool> InvariantsAtStart(const Model& model, const WitnessState& witness);

}  // namespace rondo::koord
