#pragma once

#include "base/stop.h"
#include "reach/problem/problem.h"

/// Formulas that hold nowhere in a box.
namespace rondo::reach::invariants {

/// Reports whether the formula certainly holds at no point of the box: by interval arithmetic on the box and
/// its halves. False if that is not known after so many boxes, or a point is found.
///
/// @param variables  those of the formula, by side of the box; sides that matter must be bounded.
bool HoldsNowhere(expr::Arena& arena, TermId formula, const std::vector<TermId>& variables,
                  const interval::Box& box, size_t most_boxes, const base::StopToken& stop);

}  // namespace rondo::reach::invariants
