#pragma once

#include "expr/arena.h"

/// Where terms have values: roots, logarithms, arcsines and arccosines have none outside their domains
/// (docs/adr/0005-undefined-terms.md).
namespace rondo::expr {

/// Returns a formula that holds exactly where some part of the term or formula has no value: the root of a
/// negative number, the logarithm of one that is not positive, arcsine and arccosine beyond 1. It is false if
/// there is no such part.
TermId Undefined(Arena& arena, TermId term);

/// Returns a formula that is true exactly where the given one is not. An atomic formula about an undefined
/// term is false, and so is its negation `Arena::Not`; its complement is true. Without partial functions this
/// is `Arena::Not`.
TermId Complement(Arena& arena, TermId formula);

/// Returns a formula that is true exactly where every part of the term or formula has a value.
inline TermId Defined(Arena& arena, TermId term) { return Complement(arena, Undefined(arena, term)); }

}  // namespace rondo::expr
