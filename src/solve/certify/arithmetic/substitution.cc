#include "solve/certify/arithmetic/normal.h"

namespace rondo::solve::certify {

FormulaId Normal::Substitution::Apply(FormulaId id) {
  if (const auto it = formulas_.find(id); it != formulas_.end()) return it->second;
  const Formula f = normal_.formula(id);
  FormulaId result = id;
  if (f.kind == Formula::Kind::kLiteral) {
    const PolyId p = ApplyTo(f.poly);
    if (p != f.poly) result = normal_.Literal(Minus(normal_.poly(p), ConstantPoly(f.bound)), f.relation);
  } else if (!f.parts.empty()) {
    std::vector<FormulaId> parts;
    for (const FormulaId part : f.parts) parts.push_back(Apply(part));
    result = normal_.Junction(f.kind, std::move(parts));
  }
  formulas_.emplace(id, result);
  return result;
}

PolyId Normal::Substitution::ApplyTo(PolyId id) {
  if (const auto it = polys_.find(id); it != polys_.end()) return it->second;
  const Poly p = normal_.poly(id);
  Poly result;
  for (const auto& [m, c] : p) {
    Poly product = ConstantPoly(c);
    for (const AtomId a : m) product = normal_.Times(product, Poly(normal_.poly(Atom(a))));
    for (const auto& [n, d] : product) AddTo(result, n, d);
  }
  const PolyId done = normal_.Intern(std::move(result));
  polys_.emplace(id, done);
  return done;
}

PolyId Normal::Substitution::Atom(AtomId id) {
  if (id == variable_) return value_;
  if (const auto it = atoms_.find(id); it != atoms_.end()) return it->second;
  certify::Atom a = normal_.atom(id);
  for (PolyId& arg : a.args) arg = ApplyTo(arg);
  PolyId result;
  switch (a.kind) {
    case certify::Atom::Kind::kVariable:
      result = normal_.AtomPoly(std::move(a));
      break;
    case certify::Atom::Kind::kFunction:
      result = normal_.Function(a.function, std::move(a.args));
      break;
    case certify::Atom::Kind::kQuotient:
      result = normal_.Quotient(std::move(a.args));
      break;
    case certify::Atom::Kind::kChoice:
      result = normal_.Choice(Apply(a.condition), a.args[0], a.args[1]);
      break;
  }
  atoms_.emplace(id, result);
  return result;
}

}  // namespace rondo::solve::certify
