#pragma once

#include "koord/check/model.h"

/// Decides whether states that differ only in the numbers of robots can count as one.
namespace rondo::koord::semantics {

/// Reports whether no part of the program tells robots apart but by comparing their numbers for equality, or
/// by using them as indices of cells and ports. Then renaming the robots of a run gives a run
/// (docs/theory.md, "Renaming robots"). False where that cannot be seen from the text.
bool IsSymmetric(const Model& model);

}  // namespace rondo::koord::semantics
