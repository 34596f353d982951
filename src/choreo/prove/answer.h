#pragma once

#include "expr/numeric.h"
#include "solve/solver.h"

namespace rondo::choreo {

/// Values of the real variables in an answer: of `Sat`, or in the middle of the box of `DeltaSat`.
expr::Numeric::Point PointOf(const solve::Answer& answer);

}  // namespace rondo::choreo
