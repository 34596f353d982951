#include "reach/problem/invariant.h"

#include <cmath>

#include "reach/problem/formula.h"

namespace rondo::reach {

base::Result<TermId> TermOf(const Problem& problem, const Modes& modes, const Mode& mode,
                            const Conjunct& conjunct) {
  expr::Arena& arena = *problem.arena;
  const bool of_state = conjunct.source == Conjunct::Source::kState;
  const bool of_claim = conjunct.source == Conjunct::Source::kClaim;
  const size_t count = of_state   ? problem.states.size()
                       : of_claim ? problem.claims.size()
                                  : problem.events.size();
  if (conjunct.index >= count || !std::isfinite(conjunct.bound))
    return base::Error{"an invariant is about something that the problem does not have"};
  TermId term;
  if (of_state) {
    term = modes.In(mode, problem.states[conjunct.index]);
  } else {
    const TermId formula =
        of_claim ? problem.claims[conjunct.index].formula : problem.events[conjunct.index].condition;
    const auto normal = Normalise(arena, modes.In(mode, formula));
    if (!normal.ok()) return normal.error();
    if (conjunct.comparison >= normal.value().terms.size())
      return base::Error{"an invariant is about a comparison that the problem does not have"};
    term = normal.value().terms[conjunct.comparison];
  }
  if (conjunct.negated) term = arena.Neg(term);
  return arena.Sub(term, arena.Number(arena.Real(), Rational::FromDouble(conjunct.bound)));
}

}  // namespace rondo::reach
