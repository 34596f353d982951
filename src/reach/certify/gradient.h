#pragma once

#include "reach/problem/program.h"

/// Derivatives of compiled terms on boxes, for the checker of invariants.
namespace rondo::reach::certify {

/// Reports whether the node is computed by operations only that have a value everywhere and are continuous.
bool IsContinuous(const Program& program, uint32_t node);

/// Encloses the derivatives of a node by the first `count` variables on a box, given the values of all nodes on
/// it (`ValuesOn`). What is not differentiable, or not known to be, has every derivative.
std::vector<Interval> GradientOn(const Program& program, const std::vector<Interval>& values, uint32_t node,
                                 size_t count);

}  // namespace rondo::reach::certify
