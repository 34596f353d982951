#pragma once

#include <optional>

#include "expr/arena.h"

/// Comparisons in one form, so that those of the same expression are found.
namespace rondo::solve::icp {

using expr::Rational;
using expr::TermId;

/// Says which of <, = and > satisfy a comparison: a set of bits.
using Relation = uint8_t;
inline constexpr Relation kLess = 1;
inline constexpr Relation kEqual = 2;
inline constexpr Relation kGreater = 4;

/// Is `term relation bound`, where `term` is a sum without constant whose first coefficient is 1: comparisons
/// of the same expression have the same term, however they were written.
struct Literal {
  TermId term;
  Relation relation = 0;
  Rational bound;
};

/// Reads a comparison of reals, or the negation of an equation. nullopt for any other formula.
std::optional<Literal> AsLiteral(expr::Arena& arena, TermId formula);

/// Returns the comparison as a formula.
TermId ToFormula(expr::Arena& arena, const Literal& literal);

/// Returns the formula with every comparison as AsLiteral sees it.
TermId Normalised(expr::Arena& arena, TermId formula);

/// Reports whether `a relation b` holds.
bool Holds(const Rational& a, Relation relation, const Rational& b);

}  // namespace rondo::solve::icp
