#pragma once

#include <span>

#include "reach/problem/program.h"

/// Taylor coefficients of elementary functions.
namespace rondo::reach {

/// Encloses the Taylor coefficients of a function of one variable: out[k] holds g^(k)(x) / k! for every x in
/// `at`. `function`: kReciprocal, kRoot, kSine, kCosine, kExp, kLog or kAtan. Returns false if the function
/// is not smooth on all of `at`.
bool Jet(CodeOp function, Interval at, std::span<Interval> out);

}  // namespace rondo::reach
