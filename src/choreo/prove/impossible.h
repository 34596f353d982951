#pragma once

#include "choreo/prove/keep.h"

/// Refutes that a step can be kept. Each function returns a reason why no continuous curve keeps it, or
/// nothing if that cannot be shown.
namespace rondo::choreo {

/// Refutes a step whose states are determined, by these terms over the clock: returns a moment at which they
/// break `during` or a range, jump, end without `post`, or begin too far from the start.
std::optional<KeepingVerdict> DeterminedFails(KeepingStart& start, const Curve& curve,
                                              const expr::Substitution& determined);

/// Returns a moment, up to the least duration, at which no state is allowed. Looks at `moments` of them.
std::optional<KeepingVerdict> NoState(KeepingStart& start, const expr::Substitution& determined, int moments);

/// Returns the reason if no state that is allowed at the beginning is within a bridge of the start.
std::optional<KeepingVerdict> TooFar(KeepingStart& start);

/// Returns a value of one of the free states that is not allowed at any moment, between where it begins and
/// where it ends, so that it would have to jump.
/// @param ends  where each may end.
/// @param values  how many parts the way between is cut into; the values between them are tried.
std::optional<KeepingVerdict> NeedsJump(KeepingStart& start, const std::vector<expr::TermId>& free,
                                        const expr::Substitution& ends, int values);

}  // namespace rondo::choreo
