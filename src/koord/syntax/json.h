#pragma once

#include <nlohmann/json_fwd.hpp>

#include "diag/source.h"
#include "koord/syntax/ast.h"

/// Shows Koord programs to other tools.
namespace rondo::koord {

/// Returns the syntax tree for other tools: {"items": [{"item": "event", "name": ..., "line": ..., "column":
/// ..., ...}]}. Expressions are objects with "expr" and their parts; every node that a person wrote has a
/// position.
nlohmann::json ToJson(const diag::SourceSet& sources, const Program& program);

}  // namespace rondo::koord
