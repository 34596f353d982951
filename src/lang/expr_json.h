#pragma once

#include <nlohmann/json_fwd.hpp>

#include "diag/source.h"
#include "lang/syntax_tree.h"

namespace rondo::lang {

/// An expression as {"expr": kind, "line", "column", ...}; operands under "args".
nlohmann::json ExprToJson(const diag::SourceSet& sources, const ExprPool& pool, ExprId expr);

}  // namespace rondo::lang
