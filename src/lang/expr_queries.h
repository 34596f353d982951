#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lang/syntax_tree.h"

/// Answers questions about expressions of which only the syntax is known.
namespace rondo::lang {

/// Reports whether an expression uses one of these names.
bool MentionsName(const ExprPool& pool, ExprId expr, const std::vector<std::string>& names);

/// Returns what a quantifier supposes of its variables, in the order in which it is asked: the parts of A in
/// `forall x: A implies B` (and of A2 in B, if that is `A2 implies B2`), of all of the body in `exists x: A`.
std::vector<ExprId> SuppositionsOf(const ExprPool& pool, ExprId body, bool forall);

/// Holds what `forall c in range(from, to): body` is made of.
struct RangeDomain {
  ExprId from, to, body;
};
/// Returns the range that a quantifier over ints goes over, `forall c in int: from <= c and c < to implies body` or
/// `exists c in int: from <= c and c < to and body`, as the parser makes it of `range`; nothing if it is another one.
std::optional<RangeDomain> RangeOf(const ExprPool& pool, const Expr& quantifier);

/// Returns what a string literal means: without its quotes, and with what `\\n` and the like stand for.
std::string Unquoted(const std::string& literal);

}  // namespace rondo::lang
