#pragma once

#include <optional>
#include <vector>

#include "koord/prove/obligations/problem.h"

/// Tells counterexamples from what only looks like one.
namespace rondo::koord {

/// Holds a model of a problem: of all of it, or only of the instances that were made.
struct Candidate {
  solve::Sat sat;
  bool confirmed;
};

/// Asks for a model, of numbers between -10 and 10 if there is one (`small`), and then whether it satisfies the problem with
/// every quantifier in place. Returns nothing if there is no model.
/// @param wanted  terms whose values are needed.
/// @param complete  the instances are all that there is to the problem.
std::optional<Candidate> Confirm(const Problem& problem, std::vector<TermId> wanted,
                                 const std::vector<solve::Assertion>& small, bool complete,
                                 const solve::Solver& solver, solve::Budget budget,
                                 const base::StopToken& stop);

/// Returns that every number among the terms, and every member of a record, lies between -10 and 10.
std::vector<solve::Assertion> Small(expr::Arena& arena, const std::vector<TermId>& terms);

/// Reports whether robots that the problem does not mention can be copies of one that it does.
bool OthersCanBeCopies(const expr::Arena& arena, const Problem& problem, Problems& problems);

}  // namespace rondo::koord
