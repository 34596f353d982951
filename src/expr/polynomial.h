#pragma once

#include <map>
#include <optional>
#include <vector>

#include "expr/arena.h"

namespace rondo::expr {

/// A product of atoms (terms that are no sums and no products), sorted; empty: 1.
using Monomial = std::vector<TermId>;
/// No coefficient is zero.
using Polynomial = std::map<Monomial, Rational>;

Monomial Product(const Monomial& a, const Monomial& b);
/// p + c m
void AddTo(Polynomial& p, const Monomial& m, const Rational& c);
/// nullopt if that has more than `limit` monomials.
std::optional<Polynomial> Product(const Polynomial& a, const Polynomial& b, size_t limit);

/// `term` multiplied out; nullopt if that has more than `limit` monomials.
std::optional<Polynomial> Expand(const Arena& arena, TermId term, size_t limit);

TermId ToTerm(Arena& arena, const Polynomial& polynomial);

}  // namespace rondo::expr
