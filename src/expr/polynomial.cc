#include "expr/polynomial.h"

#include <algorithm>
#include <iterator>

namespace rondo::expr {

Monomial Product(const Monomial& a, const Monomial& b) {
  Monomial product;
  std::ranges::merge(a, b, std::back_inserter(product));
  return product;
}

void AddTo(Polynomial& p, const Monomial& m, const Rational& c) {
  const auto [it, fresh] = p.emplace(m, c);
  if (!fresh) it->second = it->second + c;
  if (it->second.IsZero()) p.erase(it);
}

std::optional<Polynomial> Product(const Polynomial& a, const Polynomial& b, size_t limit) {
  Polynomial result;
  for (const auto& [m, c] : a) {
    for (const auto& [n, d] : b) {
      AddTo(result, Product(m, n), c * d);
      if (result.size() > limit) return std::nullopt;
    }
  }
  return result;
}

std::optional<Polynomial> Expand(const Arena& arena, TermId term, size_t limit) {
  Polynomial result;
  switch (arena.op(term)) {
    case Op::kNumber:
      AddTo(result, {}, arena.number(term));
      return result;
    case Op::kAdd:
      for (const TermId a : arena.args(term)) {
        const auto part = Expand(arena, a, limit);
        if (!part) return std::nullopt;
        for (const auto& [m, c] : *part) AddTo(result, m, c);
        if (result.size() > limit) return std::nullopt;
      }
      return result;
    case Op::kMul: {
      const auto a = Expand(arena, arena.arg(term, 0), limit);
      if (!a) return std::nullopt;
      const auto b = Expand(arena, arena.arg(term, 1), limit);
      return b ? Product(*a, *b, limit) : std::nullopt;
    }
    default:
      AddTo(result, {term}, Rational(1));
      return result;
  }
}

TermId ToTerm(Arena& arena, const Polynomial& p) {
  std::vector<TermId> parts{arena.Number(arena.Real(), Rational(0))};
  for (const auto& [m, c] : p) {
    TermId product = arena.Number(arena.Real(), c);
    TermId atoms;
    for (const TermId a : m) atoms = atoms.valid() ? arena.Mul(atoms, a) : a;
    parts.push_back(atoms.valid() ? arena.Mul(product, atoms) : product);
  }
  return arena.Add(std::move(parts));
}

}  // namespace rondo::expr
