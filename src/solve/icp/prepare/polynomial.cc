#include "solve/icp/prepare/polynomial.h"

#include <algorithm>
#include <set>

namespace rondo::solve::icp {

using expr::AddTo;
using expr::Arena;
using expr::Monomial;
using expr::Op;
using expr::Polynomial;
using expr::Rational;
using expr::TermId;

namespace {

constexpr size_t kMostMonomials = 200;

size_t Degree(const Polynomial& p) {
  size_t degree = 0;
  for (const auto& [m, c] : p) degree = std::max(degree, m.size());
  return degree;
}

// a x^2 + x l + rest = a (x + l / 2a)^2 - l^2 / 4a + rest, one atom after the other.
TermId CompleteSquares(Arena& arena, Polynomial p) {
  std::set<TermId> atoms;
  for (const auto& [m, c] : p) atoms.insert(m.begin(), m.end());
  std::vector<TermId> squares;
  for (const TermId x : atoms) {
    const auto lead = p.find(Monomial{x, x});
    if (lead == p.end()) continue;
    const Rational a = lead->second;
    Polynomial line;  // x + l / 2a
    AddTo(line, {x}, Rational(1));
    for (const auto& [m, c] : p) {
      if (m == Monomial{x}) AddTo(line, {}, c / (a + a));
      if (m.size() == 2 && m[0] != m[1] && (m[0] == x || m[1] == x))
        AddTo(line, {m[0] == x ? m[1] : m[0]}, c / (a + a));
    }
    const auto square = expr::Product(line, line, kMostMonomials);
    if (!square) return {};
    for (const auto& [m, c] : *square) AddTo(p, m, Rational(0) - a * c);
    const TermId root = ToTerm(arena, line);
    squares.push_back(arena.Mul(arena.Number(arena.Real(), a), arena.Mul(root, root)));
  }
  // Without squares, multiplying out would only tear factors apart.
  if (squares.empty()) return {};
  squares.push_back(ToTerm(arena, p));
  return arena.Add(std::move(squares));
}

// A product as a number times atoms and sums; sums are scaled so that their first coefficient is 1, and equal
// ones are recognised whatever their scale.
struct Factored {
  Rational coefficient{1};
  std::vector<TermId> factors;
};

void Factor(Arena& arena, TermId t, Factored& out) {
  switch (arena.op(t)) {
    case Op::kNumber:
      out.coefficient = out.coefficient * arena.number(t);
      return;
    case Op::kMul: {
      const TermId a = arena.arg(t, 0);
      const TermId b = arena.arg(t, 1);
      Factor(arena, a, out);
      Factor(arena, b, out);
      return;
    }
    case Op::kAdd: {
      const auto [lead, monic] = Monic(arena, t);
      out.coefficient = out.coefficient * lead;
      out.factors.push_back(monic);
      return;
    }
    default:
      out.factors.push_back(t);
  }
}

std::vector<TermId> Summands(const Arena& arena, TermId sum) {
  const auto args = arena.args(sum);
  return {args.begin(), args.end()};
}

// k with p = k q, if there is one.
std::optional<Rational> Ratio(const Polynomial& p, const Polynomial& q) {
  if (p.size() != q.size() || q.empty()) return std::nullopt;
  const Rational k = p.begin()->second / q.begin()->second;
  for (auto i = p.begin(), j = q.begin(); i != p.end(); ++i, ++j) {
    if (i->first != j->first || i->second != k * j->second) return std::nullopt;
  }
  return k;
}

// Summands S * f_1 + ... + S * f_n with f_1 + ... + f_n = k S + m become k S^2 + m S.
std::optional<TermId> CollectFactor(Arena& arena, TermId term, TermId s) {
  std::vector<TermId> with, without;
  for (const TermId t : Summands(arena, term)) {
    Factored product;
    Factor(arena, t, product);
    const auto it = std::find(product.factors.begin(), product.factors.end(), s);
    if (it == product.factors.end()) {
      without.push_back(t);
      continue;
    }
    product.factors.erase(it);
    TermId cofactor = arena.Number(arena.Real(), product.coefficient);
    for (const TermId f : product.factors) cofactor = arena.Mul(cofactor, f);
    with.push_back(cofactor);
  }
  if (with.size() < 2) return std::nullopt;
  const TermId cofactor = arena.Add(with);
  auto p = Expand(arena, cofactor, kMostMonomials);
  auto q = Expand(arena, s, kMostMonomials);
  if (!p || !q) return std::nullopt;
  // Up to constants: the cofactor may be k S + m.
  const Rational p0 = p->contains(Monomial{}) ? p->at(Monomial{}) : Rational(0);
  const Rational q0 = q->contains(Monomial{}) ? q->at(Monomial{}) : Rational(0);
  p->erase(Monomial{});
  q->erase(Monomial{});
  const auto k = p->empty() ? std::optional(Rational(0)) : Ratio(*p, *q);
  if (!k) return std::nullopt;
  const Rational m = p0 - *k * q0;
  without.push_back(arena.Mul(arena.Number(arena.Real(), *k), arena.Mul(s, s)));
  without.push_back(arena.Mul(arena.Number(arena.Real(), m), s));
  return arena.Add(without);
}

}  // namespace

std::pair<Rational, TermId> Monic(Arena& arena, TermId term) {
  if (arena.op(term) != Op::kAdd) return {Rational(1), term};
  const TermId first = arena.arg(term, arena.IsNumber(arena.arg(term, 0)) ? 1 : 0);
  Rational lead(1);
  if (arena.op(first) == Op::kMul && arena.IsNumber(arena.arg(first, 0)))
    lead = arena.number(arena.arg(first, 0));
  return {lead, arena.Mul(arena.Number(arena.Real(), Rational(1) / lead), term)};
}

TermId Condense(Arena& arena, TermId term) {
  if (arena.op(term) != Op::kAdd) return term;
  if (auto p = Expand(arena, term, kMostMonomials); p && Degree(*p) == 2) {
    const TermId squares = CompleteSquares(arena, std::move(*p));
    return squares.valid() ? squares : term;
  }
  for (bool changed = true; changed;) {
    changed = false;
    if (arena.op(term) != Op::kAdd) break;
    std::set<TermId> sums;
    for (const TermId t : Summands(arena, term)) {
      Factored product;
      Factor(arena, t, product);
      for (const TermId f : product.factors) {
        if (arena.op(f) == Op::kAdd) sums.insert(f);
      }
    }
    for (const TermId s : sums) {
      const auto collected = CollectFactor(arena, term, s);
      if (!collected || *collected == term) continue;
      term = *collected;
      changed = true;
      break;
    }
  }
  return term;
}

}  // namespace rondo::solve::icp
