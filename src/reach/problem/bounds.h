#pragma once

#include "reach/problem/formula.h"
#include "verdict/truth.h"

namespace rondo::reach {

/// Encloses every node of the program on a box; partial functions over the part of the box where they are
/// defined.
std::vector<Interval> ValuesOn(const Program& program, const interval::Box& box);

/// What is known of a formula on a box: by interval arithmetic, so kOpen says nothing.
verdict::Truth CheckBox(const Program& terms, const Formula& formula, const interval::Box& box);

/// The terms of the comparisons (term <= 0 or term < 0) that must hold, whatever else does.
std::vector<TermId> Necessary(const Formula& formula);

/// The variables that the formula makes equal to one number.
std::vector<std::optional<Rational>> Pinned(const expr::Arena& arena, const Program& terms,
                                            const Formula& formula);

/// The term as `slope * variable + rest`, if it is that with a number that is not zero and a rest without it.
struct Line {
  Rational slope;
  TermId rest;
};
std::optional<Line> LineIn(expr::Arena& arena, TermId term, TermId variable);

/// Shrinks the box to an enclosure of the points in it at which the formula holds: exactly where it bounds a
/// variable by a number, else by cutting off slabs in which it fails. Sides may be unbounded before and
/// after. The box becomes empty (one side is) if there is no such point. `terms`: the terms of the formula,
/// over the variables of the box.
void Contract(const expr::Arena& arena, const Program& terms, const Formula& formula, interval::Box& box);
/// The same for a formula over these variables; false, and the box as it was, if it cannot be analysed.
bool Contract(expr::Arena& arena, TermId formula, const std::vector<TermId>& variables, interval::Box& box);

}  // namespace rondo::reach
