#pragma once

#include "choreo/graph/graph.h"
#include "diag/diagnostic.h"

/// Decides which choreographies can be carried out by robots that know only what they are told (Section 4.1
/// of the paper on motion session types; docs/theory.md lists the rules).
namespace rondo::choreo {

/// Reports every violation of the rules for choices, synchronisation and time, on every branch.
void CheckWellFormed(const Graph& graph, diag::Diagnostics& diagnostics);

/// Checks rule 2: the robot that chooses tells the others, with distinct labels (Definition 4.1). Cost:
/// linear, nested choices apart.
void CheckChoices(const Graph& graph, diag::Diagnostics& diagnostics);

/// Checks rule 3: unique minimal communication after a motion, sender readiness, total synchronisation
/// between motions. From each motion a data flow goes along the graph up to the next ones: what has been said
/// on every way. Cost: linear, but for choices and threads between motions.
void CheckSynchronisation(const Graph& graph, diag::Diagnostics& diagnostics);

/// Checks rule 4: at most one motion of a step cannot be interrupted, and the others last as long; no loop
/// without motion. Cost: linear.
void CheckTime(const Graph& graph, diag::Diagnostics& diagnostics);

/// Checks rule 4 across threads: durations add up along each thread of a fork, and all threads can be through
/// at one instant, whatever the motions that cannot be interrupted take. Cost: linear, nested loops apart.
void CheckDurations(const Graph& graph, diag::Diagnostics& diagnostics);

}  // namespace rondo::choreo
