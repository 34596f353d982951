#pragma once

#include <string>

#include "lang/syntax_tree.h"

/// Expressions and types as text, for formatters and messages.
namespace rondo::lang {

/// Returns the canonical text of an expression: one blank around operators, brackets only where the grammar
/// needs them. Parsing it again gives the same tree.
std::string PrintExpr(const ExprPool& pool, ExprId expr);
/// Returns the canonical text of a type.
std::string PrintType(const ExprPool& pool, const TypeSyntax& type);

}  // namespace rondo::lang
