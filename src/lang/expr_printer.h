#pragma once

#include <optional>
#include <string>

#include "lang/syntax_tree.h"

/// Expressions and types as text, for formatters and messages.
namespace rondo::lang {

/// Returns the canonical text of an expression: one blank around operators, brackets only where the grammar
/// needs them. Parsing it again gives the same tree.
std::string PrintExpr(const ExprPool& pool, ExprId expr);
/// Returns the canonical text of a type.
std::string PrintType(const ExprPool& pool, const TypeSyntax& type);

/// Holds what `forall c in range(from, to): body` is made of.
struct RangeDomain {
  ExprId from, to, body;
};
/// Returns the range that a quantifier over ints goes over, `forall c in int: from <= c and c < to implies body` or
/// `exists c in int: from <= c and c < to and body`, as the parser makes it of `range`; nothing if it is another one.
std::optional<RangeDomain> RangeOf(const ExprPool& pool, const Expr& quantifier);

}  // namespace rondo::lang
