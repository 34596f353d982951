#pragma once

#include <string>

#include "choreo/prove/keeping_start.h"
#include "verdict/verdict.h"

/// Decides whether the motions of a step can be kept at every moment (docs/theory.md, "Curves").
namespace rondo::choreo {

/// Holds the verdict about a step, and what it stands on.
struct KeepingVerdict {
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  std::string why;                        ///< not kProved: what is in the way
  expr::Numeric::Point values;            ///< kRefuted: the moment, and the state that is in question
  std::vector<std::string> certificates;  ///< kProved: of all that had to be asked
};

/// Looks for a curve that keeps a step (`Keeping`), and proves that it does (`Keeps`). Curves are tried in
/// this order: what equations of `during` determine; straight from the start to a state that `post` allows,
/// or staying there; and through states that `during` allows at some moments, straight in between. Refuted if
/// the determined curve fails, if no state is allowed at some moment, if it begins too far from where it may,
/// or if a state would have to jump over a value. Everything else is unknown. All terms are in `arena`.
KeepingVerdict Keep(expr::Arena& arena, const Keeping& keeping, expr::TermId clock, const AskSolver& ask);

}  // namespace rondo::choreo
