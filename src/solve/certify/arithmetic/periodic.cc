#include "solve/certify/arithmetic/periodic.h"

#include <gmpxx.h>

#include <algorithm>

namespace rondo::solve::certify {

using expr::Elementary;

bool Periodic::Occurs(AtomId id) {
  if (id == variable_) return true;
  const Atom& atom = normal_.atom(id);
  if (atom.kind == Atom::Kind::kVariable) return false;
  if (atom.kind == Atom::Kind::kChoice && Occurs(atom.condition)) return true;
  return std::ranges::any_of(atom.args, [this](PolyId p) { return Occurs(p); });
}

bool Periodic::Occurs(PolyId id) {
  if (const auto it = occurs_.find(id); it != occurs_.end()) return it->second;
  bool result = false;
  for (const auto& [monomial, coefficient] : normal_.poly(id))
    result = result || std::ranges::any_of(monomial, [this](AtomId a) { return Occurs(a); });
  return occurs_[id] = result;
}

bool Periodic::Occurs(FormulaId id) {
  if (const auto it = occurs_in_.find(id); it != occurs_in_.end()) return it->second;
  const Formula& f = normal_.formula(id);
  bool result = f.kind == Formula::Kind::kLiteral && Occurs(f.poly);
  for (const FormulaId part : f.parts) result = result || Occurs(part);
  return occurs_in_[id] = result;
}

// q x + r
bool Periodic::LookAtAngle(PolyId angle) {
  for (const auto& [monomial, coefficient] : normal_.poly(angle)) {
    if (monomial == Monomial{variable_}) {
      mpz_class turns(turns_.Numerator());
      mpz_lcm(turns.get_mpz_t(), turns.get_mpz_t(), mpz_class(coefficient.Denominator()).get_mpz_t());
      turns_ = *Rational::Parse(turns.get_str());
    } else if (std::ranges::any_of(monomial, [this](AtomId a) { return Occurs(a); })) {
      return false;
    }
  }
  return true;
}

bool Periodic::Look(const Atom& atom) {
  switch (atom.kind) {
    case Atom::Kind::kVariable:
      return true;  // another one
    case Atom::Kind::kFunction:
      if (atom.function == Elementary::kSin || atom.function == Elementary::kCos) {
        if (LookAtAngle(atom.args[0])) return true;
      }
      break;
    case Atom::Kind::kChoice:
      if (!Look(atom.condition)) return false;
      break;
    case Atom::Kind::kQuotient:
      break;
  }
  return std::ranges::all_of(atom.args, [this](PolyId p) { return Look(p); });
}

bool Periodic::Look(PolyId id) {
  if (const auto it = polys_.find(id); it != polys_.end()) return it->second;
  bool result = true;
  for (const auto& [monomial, coefficient] : normal_.poly(id)) {
    for (const AtomId a : monomial) result = result && a != variable_ && Look(normal_.atom(a));
  }
  return polys_[id] = result;
}

bool Periodic::Look(FormulaId id) {
  if (const auto it = formulas_.find(id); it != formulas_.end()) return it->second;
  const Formula& f = normal_.formula(id);
  bool result = f.kind != Formula::Kind::kLiteral || Look(f.poly);
  for (const FormulaId part : f.parts) result = result && Look(part);
  return formulas_[id] = result;
}

}  // namespace rondo::solve::certify
