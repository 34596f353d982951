#pragma once

#include <optional>
#include <string>

#include "koord/prove/obligations/problem.h"
#include "koord/prove/results.h"

/// Looks for counterexamples to invariants.
namespace rondo::koord {

/// Tells a round, or an initial state, that breaks an invariant, with a small number of robots.
struct Witness {
  std::optional<size_t> action;  ///< the first action of the round; none for an initial state
  bool confirmed =
      true;  ///< satisfies everything; otherwise some quantifiers were only tried on the terms in sight
  bool reachable = false;    ///< it starts in an initial state
  bool environment = false;  ///< the environment moved in it
  int64_t robots = 0;
  std::string table;  ///< who did, read and wrote what; several lines
  WitnessState state;
};

/// Looks for a witness that invariant `i` fails in an initial state, or in any round from a state that satisfies every
/// invariant. Tries teams of 1 to 4 robots, or the fixed size if that is at most 8. A
/// witness is confirmed with every quantifier in place; without a confirmed one, returns a candidate if there
/// is any. Returns nothing if neither was found within `budget`, which is for all of the search.
std::optional<Witness> FindWitness(const Model& model, size_t invariant, WitnessOf of,
                                   std::optional<int64_t> robots, const solve::Solver& solver,
                                   const solve::Budget& budget, const base::StopToken& stop);

}  // namespace rondo::koord
