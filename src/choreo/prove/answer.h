#pragma once

#include "expr/numeric.h"
#include "solve/solver.h"

/// Reads answers of the solver.
namespace rondo::choreo {

/// Returns the values of the real variables in an answer: of `Sat`, or in the middle of the box of `DeltaSat`
/// (a finite end, or 0, where it is not bounded); none for other answers.
expr::Numeric::Point PointOf(const solve::Answer& answer);

}  // namespace rondo::choreo
