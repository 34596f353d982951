#pragma once

#include <map>
#include <optional>
#include <vector>

#include "expr/arena.h"

/// Exact arithmetic with polynomials over terms.
namespace rondo::expr {

/// Is a product of atoms (terms that are no sums and no products), sorted; the empty product is 1.
using Monomial = std::vector<TermId>;
/// Is a sum of monomials with coefficients, of which none is zero; the empty sum is 0.
using Polynomial = std::map<Monomial, Rational>;

/// Returns the product of both, sorted.
Monomial Product(const Monomial& a, const Monomial& b);
/// Adds c m to p; a coefficient that becomes zero is removed.
void AddTo(Polynomial& p, const Monomial& m, const Rational& c);
/// Returns the product; nullopt if it has more than `limit` monomials.
std::optional<Polynomial> Product(const Polynomial& a, const Polynomial& b, size_t limit);

/// Returns `term` multiplied out; nullopt if that has more than `limit` monomials.
std::optional<Polynomial> Expand(const Arena& arena, TermId term, size_t limit);

/// Returns the polynomial as a term of sort Real.
TermId ToTerm(Arena& arena, const Polynomial& polynomial);

}  // namespace rondo::expr
