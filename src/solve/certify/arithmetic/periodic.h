#pragma once

#include <map>

#include "solve/certify/arithmetic/normal.h"

/// Periods of variables, as the checker of certificates finds them.
namespace rondo::solve::certify {

/// Looks where a variable x occurs in normal forms. sin and cos of q x + r, with q = a / b a rational number
/// and r without x, have the period 2 pi b in x; what is made of nothing else of x has the period 2 pi
/// lcm(b).
class Periodic {
 public:
  Periodic(const Normal& normal, AtomId variable) : normal_(normal), variable_(variable) {}

  /// Looks at more, and reports whether all that was looked at so far has such a period.
  bool Look(PolyId poly);
  bool Look(FormulaId formula);
  /// Returns lcm(b): how many full turns the period has.
  const Rational& turns() const { return turns_; }

 private:
  bool Look(const Atom& atom);
  bool Occurs(PolyId poly);
  bool Occurs(AtomId atom);
  bool Occurs(FormulaId formula);
  bool LookAtAngle(PolyId angle);

  const Normal& normal_;
  AtomId variable_;
  Rational turns_{1};
  std::map<PolyId, bool> polys_, occurs_;
  std::map<FormulaId, bool> formulas_, occurs_in_;
};

}  // namespace rondo::solve::certify
