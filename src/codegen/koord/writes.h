#pragma once

#include <set>
#include <vector>

#include "koord/check/model.h"

/// Looks at what events write.
namespace rondo::codegen {

/// Returns the variables that a body writes as a whole and never reads behind a write: their new values need not be where the old
/// ones are. Cost: linear in the body.
std::set<size_t> OnlyWritten(const koord::Model& model, const std::vector<koord::Stmt>& body);

}  // namespace rondo::codegen
