#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "solve/certify/arithmetic/normal.h"

/// What the checker of certificates knows at a step.
namespace rondo::solve::certify {

/// Holds what is known: formulas, and ranges of polynomials into which all comparisons of one polynomial are
/// merged. Adding a fact adds what follows from it at once: bounds of roots bound their arguments, arguments
/// of partial functions lie in their domains, ends of ranges of integers are integers. A value type: a case
/// works on a copy.
class Facts {
 public:
  explicit Facts(Normal& normal) : normal_(&normal) {}

  /// Adds a fact, and what follows from it at once.
  void Add(FormulaId fact);
  /// Reports whether the formula follows from the facts by looking: no is no statement about it.
  bool Known(FormulaId formula) const;
  /// Reports whether the facts were found to contradict each other.
  bool contradiction() const { return contradiction_; }
  /// Adds lo <= variable <= hi. Throws a Rejection if the facts may have a solution and yet none in this
  /// window: they must not change when a period, no more than hi - lo, is added to the variable, but for a
  /// bound on one side that the window respects.
  void AddWindow(AtomId variable, const Rational& lo, const Rational& hi);
  /// Replaces the variable in all facts. Throws a Rejection if `variable = value` is not known.
  void Substitute(AtomId variable, PolyId value);

 private:
  struct Range {
    std::optional<Rational> lo, hi;
    bool lo_strict = false;
    bool hi_strict = false;
    std::set<Rational> excluded;
    bool Add(uint8_t relation, const Rational& bound);
    bool Implies(uint8_t relation, const Rational& bound) const;
    bool IsEmpty() const;
  };

  void AddLiteral(const Formula& literal);
  void Follow(PolyId poly);
  void Defined(PolyId poly);
  void AddComparison(PolyId poly, uint8_t relation, const Rational& bound);

  Normal* normal_;
  std::map<PolyId, Range> ranges_;
  std::set<FormulaId> formulas_;
  std::set<PolyId> defined_;
  bool contradiction_ = false;
};

}  // namespace rondo::solve::certify
