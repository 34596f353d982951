#pragma once

#include <nlohmann/json_fwd.hpp>

#include "diag/source.h"
#include "lang/syntax_tree.h"

/// Expressions for tools that read JSON.
namespace rondo::lang {

/// Returns an expression as {"expr": kind, "line", "column", ...}, lines and columns from 1; its word or
/// operator under "text", operands under "args", bound variables under "binders".
nlohmann::json ExprToJson(const diag::SourceSet& sources, const ExprPool& pool, ExprId expr);

}  // namespace rondo::lang
