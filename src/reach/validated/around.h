#pragma once

#include "reach/validated/flow/stage.h"

namespace rondo::reach {

/// Encloses the rates of the states on a box, whatever the inputs are: as many as `rates` has room for. False
/// if some function is not defined on all of it.
///
/// @param box  by state of the stage, its factor included.
bool RatesOn(const Stage& stage, const interval::Box& box, interval::Box& rates);

/// Does the term of a comparison rise wherever the flow of the stage is on this box?
bool RisesOn(const Stage& stage, const interval::Box& box, const Guard& guard);

}  // namespace rondo::reach
