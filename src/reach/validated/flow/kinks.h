#pragma once

#include "interval/interval.h"
#include "reach/problem/program.h"

/// Maxima and absolute values as linear functions with an error.
namespace rondo::reach {

/// Says that a function of one number is `slope * x` plus some number in `offset`.
struct Chord {
  double slope = 0;
  Interval offset;
};
/// Encloses max(x, 0), or |x|, for all x of an interval around zero: the chord, and how far above the function it
/// gets.
Chord ChordOfMax(Interval x);
Chord ChordOfAbs(Interval x);

/// Makes node `n` of the program, a maximum or an absolute value, a linear one that encloses it as long as the
/// difference of the arguments of a maximum, or the argument of an absolute value, lies in `x`: where that does not
/// change its sign, exactly. What is added as an error may be another number for each value of the variables.
void ReplaceKink(Program& program, uint32_t n, Interval x);

/// Returns the program of the nodes before `n`, with a single output: what node `n` compares with zero.
Program ComparedAt(const Program& program, uint32_t n);

}  // namespace rondo::reach
