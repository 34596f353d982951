#pragma once

#include "reach/validated/flow/stage.h"

/// The flow on a box: rates, and the sign of the rate of a term.
namespace rondo::reach {

/// Encloses the rates of the states on a box, per second, whatever the inputs are: as many as `rates` has
/// room for. Returns false if some function is not defined on all of it.
///
/// @param box  by state of the stage, its factor included.
bool RatesOn(const Stage& stage, const interval::Box& box, interval::Box& rates);

/// Reports whether the first term of the condition rises, for sure, wherever the flow of the stage is on this
/// box. False if its rate depends on an input, which may jump.
bool RisesOn(const Stage& stage, const interval::Box& box, const Guard& guard);

}  // namespace rondo::reach
