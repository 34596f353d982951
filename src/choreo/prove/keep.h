#pragma once

#include <functional>
#include <string>

#include "choreo/obligations/obligations.h"
#include "choreo/prove/curve.h"
#include "choreo/prove/verdict.h"
#include "expr/numeric.h"
#include "solve/solver.h"

namespace rondo::choreo {

struct KeepingVerdict {
  Verdict verdict = Verdict::kUnknown;
  std::string why;                        ///< not kProved: what is in the way
  expr::Numeric::Point values;            ///< kRefuted: the moment, and the state that is in question
  std::vector<std::string> certificates;  ///< kProved: of all that had to be asked
};

/// Looks for a curve that keeps a step (`Keeping`), and proves that it does. Curves are tried in this order:
/// what equations of `during` determine; straight from the start to a state that `post` allows, or staying
/// there; and through states that `during` allows at some moments, straight in between. That a curve keeps
/// `during` at *every* moment is asked of the solver, as formulas over the clock and the start, and where a
/// formula is convex along the curve, at its ends. Where all states are determined, or no state is allowed at
/// some moment, or a state would have to jump over a value, it is refuted. Everything else is unknown.
///
/// `ask(formula, certificate)` asks for a solution; all terms are in `arena`.
KeepingVerdict Keep(expr::Arena& arena, const Keeping& keeping, expr::TermId clock,
          const std::function<solve::Answer(expr::TermId, bool)>& ask);

}  // namespace rondo::choreo
