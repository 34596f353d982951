#pragma once

#include "reach/certify/models/linearise.h"

/// Programs without maxima and absolute values, for the checker.
namespace rondo::reach::certify {

/// Returns the first node, from `from` on, that is a maximum or an absolute value whose side is open on a box; the
/// number of nodes if there is none.
uint32_t OpenKink(const Program& program, const OnBox& on, uint32_t from);

/// Returns a program with one output: the argument of the absolute value at this node, or the difference of the
/// arguments of the maximum.
Program ArgumentOf(const Program& program, uint32_t node);

/// Puts a sum in the place of such a node, with a constant of which only bounds are known: it may be another one
/// for each value of the variables. Right for all arguments (see above) in the interval.
void Straighten(Program& program, uint32_t node, Interval argument);

}  // namespace rondo::reach::certify
