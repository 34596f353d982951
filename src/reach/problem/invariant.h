#pragma once

#include <vector>

#include "reach/problem/modes.h"

/// Inductive invariants of a problem whose modes events change: what engine and checker write of them.
namespace rondo::reach {

/// States that a term is at most a bound. The term is one that the problem itself mentions.
struct Conjunct {
  /// Says where the term comes from.
  enum class Source : uint8_t {
    kState,  ///< the state with this index
    kClaim,  ///< a comparison in the claim with this index
    kEvent,  ///< a comparison in the condition of the event with this index
  };
  Source source = Source::kState;
  size_t index = 0;
  size_t comparison = 0;  ///< of kClaim, kEvent: which one, of those of the formula in the mode (`Normalise`)
  bool negated = false;   ///< whether it is about the negative of the term
  double bound = 0;

  bool operator==(const Conjunct&) const = default;
};

/// Says what holds whenever the discrete states have certain values.
struct ModeInvariant {
  std::vector<Rational> mode;  ///< the values, in the order of `Modes::states`
  std::vector<Conjunct> conjuncts;
};
/// Says what holds at every time, by mode; a mode that is not mentioned is never reached.
using Invariant = std::vector<ModeInvariant>;

/// Returns the term that the conjunct says is at most zero, in this mode.
///
/// @error if the problem has no such term.
base::Result<TermId> TermOf(const Problem& problem, const Modes& modes, const Mode& mode,
                            const Conjunct& conjunct);

}  // namespace rondo::reach
