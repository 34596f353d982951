#include "solve/certify/arithmetic/normal.h"

#include <fmt/format.h>
#include <gmpxx.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "solve/certify/arithmetic/known_value.h"

namespace rondo::solve::certify {

using expr::Elementary;
using expr::Op;

namespace {

constexpr size_t kMostMonomials = 20'000;
constexpr size_t kLongestMonomial = 1'000;
constexpr uint32_t kDeepestAtom = 500;
constexpr uint64_t kLargestFormula = 1'000'000;

Monomial Merge(const Monomial& a, const Monomial& b) {
  Monomial result;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

// c = f^2 r for a positive c; r is an integer without squares of small primes, and no square itself unless 1.
std::pair<Rational, Rational> SquareFactor(const Rational& c) {
  const mpz_class denominator(c.Denominator());
  mpz_class rest = mpz_class(c.Numerator()) * denominator, factor = 1;
  constexpr unsigned kLargest = 1'000;
  for (unsigned p = 2; p <= kLargest; ++p) {
    const mpz_class square = mpz_class(p) * p;
    while (mpz_divisible_p(rest.get_mpz_t(), square.get_mpz_t()) != 0) {
      rest /= square;
      factor *= p;
    }
  }
  if (mpz_perfect_square_p(rest.get_mpz_t()) != 0) {
    factor *= sqrt(rest);
    rest = 1;
  }
  return {*Rational::Parse(factor.get_str()) / *Rational::Parse(denominator.get_str()),
          *Rational::Parse(rest.get_str())};
}

}  // namespace

void AddTo(Poly& p, Monomial m, const Rational& c) {
  if (c.IsZero()) return;
  const auto [it, fresh] = p.emplace(std::move(m), c);
  if (!fresh) it->second = it->second + c;
  const bool large = p.size() > kMostMonomials || it->first.size() > kLongestMonomial;
  if (it->second.IsZero()) p.erase(it);
  if (large) throw Rejection("a polynomial grows too large to be compared");
}

uint8_t Mirrored(uint8_t r) {
  return static_cast<uint8_t>((r & kEven) | ((r & kBelow) != 0 ? kAbove : 0) |
                              ((r & kAbove) != 0 ? kBelow : 0));
}

std::optional<Rational> ConstantOf(const Poly& p) {
  if (p.empty()) return Rational(0);
  if (p.size() == 1 && p.begin()->first.empty()) return p.begin()->second;
  return std::nullopt;
}

Poly Normal::ConstantPoly(const Rational& value) {
  Poly p;
  AddTo(p, {}, value);
  return p;
}

Poly Normal::Minus(const Poly& a, const Poly& b) {
  Poly result = a;
  for (const auto& [m, c] : b) AddTo(result, m, Rational(0) - c);
  return result;
}

AtomId Normal::Single(const Poly& p) const {
  const bool single = p.size() == 1 && p.begin()->first.size() == 1 && p.begin()->second == Rational(1);
  return single ? p.begin()->first[0] : AtomId();
}

PolyId Normal::Intern(Poly poly) {
  if (const auto it = poly_ids_.find(poly); it != poly_ids_.end()) return it->second;
  const PolyId id(polys_.size());
  polys_.push_back(poly);
  poly_ids_.emplace(std::move(poly), id);
  return id;
}

FormulaId Normal::Intern(Formula formula) {
  if (const auto it = formula_ids_.find(formula); it != formula_ids_.end()) return it->second;
  uint64_t size = 1;
  for (const FormulaId part : formula.parts) size += sizes_[part.index()];
  if (size > kLargestFormula) throw Rejection("a formula grows too large");
  const FormulaId id(formulas_.size());
  sizes_.push_back(size);
  formulas_.push_back(formula);
  formula_ids_.emplace(std::move(formula), id);
  return id;
}

PolyId Normal::AtomPoly(Atom atom) {
  auto it = atom_ids_.find(atom);
  if (it == atom_ids_.end()) {
    uint32_t depth = 0;
    for (const PolyId arg : atom.args) {
      for (const auto& [m, c] : poly(arg)) {
        for (const AtomId a : m) depth = std::max(depth, depths_[a.index()] + 1);
      }
    }
    if (depth > kDeepestAtom) throw Rejection("functions are nested too deeply");
    depths_.push_back(depth);
    atoms_.push_back(atom);
    it = atom_ids_.emplace(std::move(atom), AtomId(atoms_.size() - 1)).first;
  }
  return Intern(Poly{{Monomial{it->second}, Rational(1)}});
}

AtomId Normal::Variable(TermId variable) {
  Atom atom;
  atom.variable = variable;
  atom.integral = arena_.sort_of(variable) != arena_.Real();
  return Single(poly(AtomPoly(std::move(atom))));
}

// Products that the normal form knows to be something else are replaced.
void Normal::AddProduct(Poly& out, Monomial m, const Rational& coefficient) {
  const auto is = [&](AtomId id, Elementary f) {
    return atoms_[id.index()].kind == Atom::Kind::kFunction && atoms_[id.index()].function == f;
  };
  std::optional<size_t> number_root;
  for (size_t i = 0; i < m.size(); ++i) {
    const Atom& a = atoms_[m[i].index()];
    if (is(m[i], Elementary::kCos) && i + 1 < m.size() && m[i + 1] == m[i]) {
      Atom sine = a;
      sine.function = Elementary::kSin;
      const AtomId s = Single(poly(AtomPoly(std::move(sine))));
      m.erase(m.begin() + static_cast<std::ptrdiff_t>(i), m.begin() + static_cast<std::ptrdiff_t>(i) + 2);
      const Monomial squared = Merge(m, {s, s});
      AddProduct(out, std::move(m), coefficient);
      AddProduct(out, squared, Rational(0) - coefficient);
      return;
    }
    if (is(m[i], Elementary::kSqrt) && !number_root) {
      const auto value = ConstantOf(poly(a.args[0]));
      if (value && *value >= Rational(0)) number_root = i;
    }
  }
  if (number_root) {
    for (size_t j = 0; j < m.size(); ++j) {
      if (j == *number_root || !is(m[j], Elementary::kSqrt)) continue;
      const Poly c = poly(atoms_[m[*number_root].index()].args[0]);
      const Poly e = poly(atoms_[m[j].index()].args[0]);
      const PolyId root = Function(Elementary::kSqrt, {Intern(Times(c, e))});
      Monomial others;
      for (size_t k = 0; k < m.size(); ++k) {
        if (k != j && k != *number_root) others.push_back(m[k]);
      }
      const Poly p = poly(root);
      for (const auto& [n, d] : p) AddProduct(out, Merge(others, n), coefficient * d);
      return;
    }
  }
  AddTo(out, std::move(m), coefficient);
}

Poly Normal::Times(const Poly& a, const Poly& b) {
  Poly result;
  for (const auto& [m, c] : a) {
    for (const auto& [n, d] : b) AddProduct(result, Merge(m, n), c * d);
  }
  return result;
}

PolyId Normal::Function(Elementary function, std::vector<PolyId> args) {
  std::vector<Rational> values;
  for (const PolyId a : args) {
    if (const auto value = ConstantOf(poly(a))) values.push_back(*value);
  }
  if (values.size() == args.size()) {
    if (const auto value = KnownValue(function, values)) return Intern(ConstantPoly(*value));
  }
  if (function == Elementary::kPower) {
    if (const auto value = ConstantOf(poly(args[1]))) {
      if (const auto product = WholePower(args[0], *value)) return *product;
    }
  }
  // sqrt(f^2 e) = f sqrt(e), so that the first coefficient of e is without squares.
  if (function == Elementary::kSqrt && !poly(args[0]).empty()) {
    Poly p = poly(args[0]);
    const Rational lead = p.begin()->second;
    const auto [factor, rest] = SquareFactor(lead < Rational(0) ? Rational(0) - lead : lead);
    if (!(factor == Rational(1))) {
      const Rational scale = Rational(1) / (factor * factor);
      for (auto& [m, c] : p) c = c * scale;
      return Intern(Times(Poly(poly(Function(function, {Intern(std::move(p))}))), ConstantPoly(factor)));
    }
  }
  Atom atom;
  atom.kind = Atom::Kind::kFunction;
  atom.function = function;
  atom.args = std::move(args);
  return AtomPoly(std::move(atom));
}

// p^n for an integer n is a product, or its reciprocal.
std::optional<PolyId> Normal::WholePower(PolyId base, const Rational& exponent) {
  constexpr int64_t kMost = 64;
  if (!exponent.IsInteger() || exponent > Rational(kMost) || exponent < Rational(-kMost)) return std::nullopt;
  const auto n = static_cast<int64_t>(exponent.ToDouble());
  Poly product = ConstantPoly(Rational(1));
  for (int64_t i = 0; i < std::abs(n); ++i) product = Times(product, Poly(poly(base)));
  const PolyId whole = Intern(std::move(product));
  return n < 0 ? Quotient({Intern(ConstantPoly(Rational(1))), whole}) : whole;
}

PolyId Normal::Choice(FormulaId condition, PolyId then, PolyId otherwise) {
  const Formula& c = formula(condition);
  if (c.kind == Formula::Kind::kTrue || then == otherwise) return then;
  if (c.kind == Formula::Kind::kFalse) return otherwise;
  // The number of a truth value.
  const bool bit = poly(then) == ConstantPoly(Rational(1)) && poly(otherwise).empty();
  if (bit && c.kind == Formula::Kind::kLiteral && c.relation == (kAbove | kEven) && c.bound == Rational(1)) {
    const AtomId a = Single(poly(c.poly));
    if (a.valid() && atom(a).kind == Atom::Kind::kVariable &&
        arena_.sort_of(atom(a).variable) == arena_.Bool())
      return c.poly;
  }
  Atom atom;
  atom.kind = Atom::Kind::kChoice;
  atom.condition = condition;
  atom.args = {then, otherwise};
  return AtomPoly(std::move(atom));
}

PolyId Normal::Quotient(std::vector<PolyId> args) {
  if (const auto value = ConstantOf(poly(args[1])); value && !value->IsZero())
    return Intern(Times(Poly(poly(args[0])), ConstantPoly(Rational(1) / *value)));
  Atom atom;
  atom.kind = Atom::Kind::kQuotient;
  atom.args = std::move(args);
  return AtomPoly(std::move(atom));
}

PolyId Normal::Number(TermId t) {
  if (const auto it = numbers_.find(t); it != numbers_.end()) return it->second;
  const PolyId id = NewNumber(t);
  numbers_.emplace(t, id);
  return id;
}

PolyId Normal::NewNumber(TermId t) {
  std::vector<PolyId> args;
  const Op op = arena_.op(t);
  if (arena_.sort_of(t) == arena_.Bool() && op != Op::kVariable)
    throw Rejection("a number should stand here");
  for (const TermId a : arena_.args(t)) {
    if (arena_.sort_of(a) != arena_.Bool()) args.push_back(Number(a));
  }
  switch (op) {
    case Op::kNumber:
      return Intern(ConstantPoly(arena_.number(t)));
    case Op::kVariable:
      return Intern(Poly{{Monomial{Variable(t)}, Rational(1)}});
    case Op::kAdd: {
      Poly sum;
      for (const PolyId a : args) {
        for (const auto& [m, c] : poly(a)) AddTo(sum, m, c);
      }
      return Intern(std::move(sum));
    }
    case Op::kMul:
      return Intern(Times(Poly(poly(args[0])), Poly(poly(args[1]))));
    case Op::kToReal:
      return args[0];
    case Op::kElementary:
      return Function(arena_.elementary_of(t), std::move(args));
    case Op::kIte:
      return Choice(Of(arena_.arg(t, 0)), args[0], args[1]);
    case Op::kDivide:
      return Quotient(std::move(args));
    default:
      throw Rejection(fmt::format("terms made with `{}` cannot be checked", expr::Name(op)));
  }
}

FormulaId Normal::Literal(const Poly& difference, uint8_t relation) {
  Poly rest = difference;
  Rational constant;
  if (const auto it = rest.find(Monomial{}); it != rest.end()) {
    constant = it->second;
    rest.erase(it);
  }
  const auto truth = [&](bool value) {
    return Intern(Formula{value ? Formula::Kind::kTrue : Formula::Kind::kFalse, {}, 0, {}, {}});
  };
  if (rest.empty()) {
    const uint8_t is = constant < Rational(0) ? kBelow : constant.IsZero() ? kEven : kAbove;
    return truth((relation & is) != 0);
  }
  const Rational lead = rest.begin()->second;
  for (auto& [m, c] : rest) c = c / lead;
  Formula f{Formula::Kind::kLiteral, {}, relation, Rational(0) - constant / lead, {}};
  if (lead < Rational(0)) f.relation = Mirrored(relation);
  if (const AtomId a = Single(rest); a.valid() && atom(a).integral) {
    const Rational floor = f.bound.Floor();
    if (f.relation == kEven || f.relation == (kBelow | kAbove)) {
      if (!f.bound.IsInteger()) return truth(f.relation != kEven);
    } else if ((f.relation & kAbove) == 0) {
      f.bound = f.bound.IsInteger() && (f.relation & kEven) == 0 ? f.bound - Rational(1) : floor;
      f.relation = kBelow | kEven;
    } else {
      f.bound = f.bound.IsInteger() && (f.relation & kEven) != 0 ? f.bound : floor + Rational(1);
      f.relation = kAbove | kEven;
    }
  }
  f.poly = Intern(std::move(rest));
  return Intern(std::move(f));
}

FormulaId Normal::Compare(TermId a, TermId b, uint8_t relation) {
  const PolyId left = Number(a);
  const PolyId right = Number(b);
  return Literal(Minus(poly(left), poly(right)), relation);
}

FormulaId Normal::Junction(Formula::Kind kind, std::vector<FormulaId> parts) {
  const bool conjunction = kind == Formula::Kind::kAnd;
  std::set<FormulaId> kept;
  while (!parts.empty()) {
    const FormulaId p = parts.back();
    parts.pop_back();
    const Formula& f = formula(p);
    if (f.kind == kind) {
      parts.insert(parts.end(), f.parts.begin(), f.parts.end());
    } else if (f.kind == (conjunction ? Formula::Kind::kFalse : Formula::Kind::kTrue)) {
      return p;
    } else if (f.kind != (conjunction ? Formula::Kind::kTrue : Formula::Kind::kFalse)) {
      kept.insert(p);
    }
  }
  if (kept.size() == 1) return *kept.begin();
  if (kept.empty())
    return Intern(Formula{conjunction ? Formula::Kind::kTrue : Formula::Kind::kFalse, {}, 0, {}, {}});
  return Intern(Formula{kind, {}, 0, {}, {kept.begin(), kept.end()}});
}

FormulaId Normal::Of(TermId t, bool positive) {
  if (const auto it = forms_.find({t, positive}); it != forms_.end()) return it->second;
  const FormulaId id = NewFormula(t, positive);
  forms_.emplace(std::pair(t, positive), id);
  return id;
}

FormulaId Normal::NewFormula(TermId t, bool positive) {
  const auto args = arena_.args(t);
  switch (arena_.op(t)) {
    case Op::kBool:
      return Literal({}, (t == arena_.True()) == positive ? kEven : kBelow);
    case Op::kNot:
      return Of(args[0], !positive);
    case Op::kAnd:
    case Op::kOr: {
      std::vector<FormulaId> parts;
      for (const TermId a : args) parts.push_back(Of(a, positive));
      return (arena_.op(t) == Op::kAnd) == positive ? And(std::move(parts)) : Or(std::move(parts));
    }
    case Op::kIte:
      return Or({And({Of(args[0], true), Of(args[1], positive)}),
                 And({Of(args[0], false), Of(args[2], positive)})});
    case Op::kEq:
      if (arena_.sort_of(args[0]) == arena_.Bool()) {
        return Or({And({Of(args[0], true), Of(args[1], positive)}),
                   And({Of(args[0], false), Of(args[1], !positive)})});
      }
      return Compare(args[0], args[1], positive ? kEven : kBelow | kAbove);
    case Op::kLe:
      return Compare(args[0], args[1], positive ? kBelow | kEven : kAbove);
    case Op::kLt:
      return Compare(args[0], args[1], positive ? kBelow : kAbove | kEven);
    case Op::kVariable: {
      Poly p{{Monomial{Variable(t)}, Rational(1)}};
      return positive ? Literal(Minus(p, ConstantPoly(Rational(1))), kAbove | kEven)
                      : Literal(p, kBelow | kEven);
    }
    default:
      throw Rejection(fmt::format("formulas made with `{}` cannot be checked", expr::Name(arena_.op(t))));
  }
}

}  // namespace rondo::solve::certify
