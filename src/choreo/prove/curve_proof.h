#pragma once

#include "choreo/prove/keeping_start.h"

/// States what has to be shown of a curve so that it keeps a step (docs/theory.md, "Curves"). Each function
/// but `Keeps` returns where something fails: a formula that must have no solution.
namespace rondo::choreo {

/// Proves that, from every state of the start, the curve begins no farther away than a bridge, is continuous,
/// keeps `during` at every moment, and ends with `post`. Certificates are left with `start`. Cost: one
/// question for each part of `during` and each piece of the curve that is not plain.
bool Keeps(KeepingStart& start, const Curve& curve);

/// Returns where the curve begins farther than a bridge from where the step begins; one formula for each
/// state.
std::vector<expr::TermId> BridgeFails(KeepingStart& start, const CurvePiece& first);
/// Returns where a state would have two values at the moment between two pieces.
expr::TermId Jumps(KeepingStart& start, const CurvePiece& left, const CurvePiece& right);
/// Returns where `post` does not hold at the end; nowhere if the step goes on for ever.
expr::TermId PostFails(KeepingStart& start, const Curve& curve);

}  // namespace rondo::choreo
