#pragma once

#include <string>

#include "lang/syntax_tree.h"

namespace rondo::lang {

/// The canonical text of an expression: one blank around operators, brackets only where the grammar needs
/// them. Parsing it again gives the same tree.
std::string PrintExpr(const ExprPool& pool, ExprId expr);
std::string PrintType(const ExprPool& pool, const TypeSyntax& type);

}  // namespace rondo::lang
