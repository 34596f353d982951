#pragma once

#include "reach/problem/formula.h"
#include "verdict/truth.h"

/// Formulas and terms on boxes of states: three-valued evaluation and contraction by interval arithmetic.
namespace rondo::reach {

/// Encloses every node of the program on a box; partial functions over the part of the box where they are
/// defined.
std::vector<Interval> ValuesOn(const Program& program, const interval::Box& box);

/// Tells what is known of a formula on a box: by interval arithmetic, so kOpen says nothing.
verdict::Truth CheckBox(const Program& terms, const Formula& formula, const interval::Box& box);

/// Returns the terms of the comparisons (term <= 0 or term < 0) that must hold, whatever else does.
std::vector<TermId> Necessary(const Formula& formula);

/// Returns, by variable of the program, the one number that the formula makes it equal to, if there is one.
std::vector<std::optional<Rational>> Pinned(const expr::Arena& arena, const Program& terms,
                                            const Formula& formula);

/// Is a term written as `slope * variable + rest`, with a number that is not zero and a rest without the
/// variable.
struct Line {
  Rational slope;
  TermId rest;
};
/// Writes the term so; nothing if it is not linear in the variable, or does not contain it.
std::optional<Line> LineIn(expr::Arena& arena, TermId term, TermId variable);

/// Shrinks the box to an enclosure of the points in it at which the formula holds: exactly where it bounds a
/// variable by a number, else by cutting off slabs in which it fails. Sides may be unbounded before and
/// after. The box becomes empty (one side is) if no such point is left.
///
/// @param terms  the terms of the formula, over the variables of the box.
void Contract(const expr::Arena& arena, const Program& terms, const Formula& formula, interval::Box& box);
/// Does the same for a formula over these variables. Returns false, and leaves the box as it was, if the
/// formula cannot be analysed.
bool Contract(expr::Arena& arena, TermId formula, const std::vector<TermId>& variables, interval::Box& box);

}  // namespace rondo::reach
