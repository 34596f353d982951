#pragma once

#include "choreo/prove/keep.h"

/// Why no continuous curve keeps a step. Each is nothing if that cannot be shown.
namespace rondo::choreo {

/// The states are determined, by these terms over the clock: a moment at which they break `during` or a
/// range, jump, end without `post`, or begin too far from the start.
std::optional<KeepingVerdict> DeterminedFails(KeepingStart& start, const Curve& curve,
                                              const expr::Substitution& determined);

/// A moment, up to the least duration, at which no state is allowed.
std::optional<KeepingVerdict> NoState(KeepingStart& start, const expr::Substitution& determined, int moments);

/// No state that is allowed at the beginning is within a bridge of the start.
std::optional<KeepingVerdict> TooFar(KeepingStart& start);

/// A value of one of the free states that is not allowed at any moment, between where it begins and where it
/// ends; `ends`: where each may end.
std::optional<KeepingVerdict> NeedsJump(KeepingStart& start, const std::vector<expr::TermId>& free,
                                        const expr::Substitution& ends, int values);

}  // namespace rondo::choreo
