#pragma once

#include <functional>
#include <vector>

#include "koord/prove/obligations/task.h"

/// Proves that invariants are kept by robots that lose the others (docs/theory.md, "Robots that are cut off").
namespace rondo::koord {

/// Asks the questions of these tasks, with as many instances as the effort says, and notes the answers in them.
using SolveTasks = std::function<void(const std::vector<Task*>&, Effort)>;

/// Asks of each invariant whether rounds in which robots are cut off keep it. First of all such rounds; where that is
/// not proved, of those in which robots act at once, or in which those who are cut off have nothing urgent to do.
/// @return for each invariant a task with the last answer, and the limits that it was proved with.
std::vector<Task> ProveCutOff(Problems& problems, const SolveTasks& solve);

/// Returns what a program's proofs assume of robots that are cut off, for people.
/// @param proved  what `ProveCutOff` returned; nothing if it was not asked.
std::vector<std::string> AssumedOfCutOff(const Model& model, const std::vector<Task>& proved);

}  // namespace rondo::koord
