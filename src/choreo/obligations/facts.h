#pragma once

#include <functional>
#include <set>
#include <vector>

#include "choreo/graph/graph.h"

/// Finds what is known at each node of a choreography, and cuts such knowledge to size.
namespace rondo::choreo {

/// Holds what is known of the state when a node is reached: one of several conjunctions of formulas. Without
/// any, the node is never reached.
using Conjunction = std::set<expr::TermId>;
using Facts = std::set<Conjunction>;

/// Returns, for each node of a graph, what holds whenever it is reached, if all motions keep their contracts
/// and all assumptions hold. These are strongest postconditions along the graph: a motion drops what it
/// modifies, and what nobody determines, and adds its `post`; a choice adds its guard; a thread keeps what is
/// about its own robots, and a join has what all of its threads have. Loops are followed until nothing new
/// comes; where more than a few ways meet, only what they have in common is kept. A node that is never
/// reached has no facts at all.
std::vector<Facts> FactsOf(const Graph& graph, expr::Arena& arena);

/// Returns the conjuncts of a formula.
Conjunction Conjuncts(const expr::Arena& arena, expr::TermId formula);

/// Takes those of `parts` that mention one of these variables, or one that such a part mentions, and so on,
/// or none at all; `variables` grows accordingly.
std::vector<expr::TermId> TakeConnected(
    std::set<expr::TermId>& variables, std::vector<expr::TermId>& parts,
    const std::function<const std::set<expr::TermId>&(expr::TermId)>& variables_of);

/// Returns the disjunction as a term; false if there is none.
expr::TermId ToTerm(expr::Arena& arena, const Facts& facts);

/// Returns how long a step takes: at least as long as any of its motions has to, at most as long as each of
/// them can.
Duration StepOf(const Node& motion);

/// Returns the states that the motions of a step modify.
std::set<expr::TermId> ModifiedIn(const Graph& graph, const Node& motion);

/// Returns what may change while a step goes on: what its motions modify, inputs, and the environment.
std::set<expr::TermId> ChangingIn(const Graph& graph, const Node& motion);

/// Returns those conjuncts that stay true while a step goes on: they depend neither on what its motions
/// modify nor on inputs and the environment.
expr::TermId Kept(const Graph& graph, const Node& motion, const Facts& facts, expr::Arena& arena);

/// Returns those conjuncts that are about no other robot than this one.
expr::TermId OwnFacts(const Graph& graph, RobotId robot, const Facts& facts, expr::Arena& arena);

}  // namespace rondo::choreo
