#pragma once

#include <unordered_map>
#include <vector>

#include "expr/arena.h"
#include "interval/interval.h"
#include "verdict/truth.h"

/// Formulas at one point: how a `sat` is verified.
namespace rondo::solve::icp {

/// Gives variables their values.
using Assignment = std::unordered_map<expr::TermId, expr::Rational>;

/// Evaluates formulas at one point, rationally where that is possible and with intervals otherwise. Written
/// for certainty, not for speed, and apart from the tape: what it calls true is true, everything in it being
/// defined.
class PointChecker {
 public:
  PointChecker(const expr::Arena& arena, const Assignment& point) : arena_(arena), point_(point) {}
  /// Lets the variable have any value in `range`: what is called true is true for all of them.
  void Widen(expr::TermId variable, interval::Interval range) { widened_[variable] = range; }
  /// Tells what is known of the formula at the point: kTrue and kFalse are certain.
  verdict::Truth Check(expr::TermId formula);
  /// Returns the value of a term, if it is known exactly.
  std::optional<expr::Rational> Exact(expr::TermId term);
  /// Encloses the value of a term; empty where it may have none.
  interval::Interval Enclosure(expr::TermId term);

 private:
  struct Value {
    std::optional<expr::Rational> exact;
    interval::Interval range;
    bool defined = true;
  };
  const Value& Number(expr::TermId t);
  Value NewNumber(expr::TermId t);
  verdict::Truth Compare(expr::TermId atom, bool positive);

  const expr::Arena& arena_;
  const Assignment& point_;
  std::unordered_map<expr::TermId, interval::Interval> widened_;
  std::unordered_map<expr::TermId, Value> values_;
};

}  // namespace rondo::solve::icp
