#pragma once

#include "reach/certify/models/linearise.h"
#include "reach/certify/step.h"

/// Second derivatives along the flow: with them, the checker tells a touch of an event's boundary from
/// crossings.
namespace rondo::reach::certify {

/// Encloses the second derivatives of outputs of `observed` along the flow, per second squared, where states
/// and inputs are in `box`: by output. Where one does not exist, or may jump, it is everything: behind kinks
/// that are open, and where inputs that are not constant have a part in it.
///
/// If an enclosure is finite, the first derivative is continuous, whatever the inputs do.
/// @source Moore, Interval Analysis (1966), §11: Taylor coefficients along the flow, here of order two.
std::vector<Interval> Accelerations(const Dynamics& dynamics, const Program& observed,
                                    const interval::Box& box);

}  // namespace rondo::reach::certify
