#pragma once

#include "expr/arena.h"

namespace rondo::expr {

/// Where some part of a term or a formula has no value: the root of a negative number, the logarithm of one
/// that is not positive, arcsine and arccosine beyond 1. False if there is no such part.
TermId Undefined(Arena& arena, TermId term);

/// True exactly where the formula is not. An atomic formula about an undefined term is false, and so is its
/// negation `Arena::Not`; its complement is true. Without partial functions this is `Arena::Not`.
TermId Complement(Arena& arena, TermId formula);

/// True exactly where every part of the term or formula has a value.
inline TermId Defined(Arena& arena, TermId term) { return Complement(arena, Undefined(arena, term)); }

}  // namespace rondo::expr
