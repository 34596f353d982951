#pragma once

#include "koord/check/model.h"

namespace rondo::koord::semantics {

/// Does no part of the program tell robots apart but by comparing them for equality? Then renaming the robots
/// of a run gives a run (docs/theory.md, "Exploration").
bool IsSymmetric(const Model& model);

}  // namespace rondo::koord::semantics
