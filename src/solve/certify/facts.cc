#include "solve/certify/facts.h"

#include <algorithm>

#include "solve/certify/arithmetic/periodic.h"

namespace rondo::solve::certify {

using expr::Elementary;

namespace {

constexpr size_t kMostDigits = 1'000;

}  // namespace

bool Facts::Range::Add(uint8_t relation, const Rational& bound) {
  bool changed = false;
  if (relation == (kBelow | kAbove)) {
    changed = excluded.insert(bound).second;
  } else {
    const bool strict = (relation & kEven) == 0;
    if ((relation & kAbove) == 0 && (!hi || bound < *hi || (bound == *hi && strict && !hi_strict))) {
      hi = bound;
      hi_strict = strict;
      changed = true;
    }
    if ((relation & kBelow) == 0 && (!lo || bound > *lo || (bound == *lo && strict && !lo_strict))) {
      lo = bound;
      lo_strict = strict;
      changed = true;
    }
  }
  if (lo && excluded.contains(*lo)) lo_strict = true;
  if (hi && excluded.contains(*hi)) hi_strict = true;
  return changed;
}

bool Facts::Range::IsEmpty() const {
  return lo && hi && (*lo > *hi || (*lo == *hi && (lo_strict || hi_strict)));
}

bool Facts::Range::Implies(uint8_t relation, const Rational& bound) const {
  const bool below = hi && (*hi < bound || (*hi == bound && hi_strict));
  const bool above = lo && (*lo > bound || (*lo == bound && lo_strict));
  const bool not_above = below || (hi && *hi == bound);
  const bool not_below = above || (lo && *lo == bound);
  switch (relation) {
    case kBelow:
      return below;
    case kBelow | kEven:
      return not_above;
    case kEven:
      return not_above && not_below;
    case kAbove | kEven:
      return not_below;
    case kAbove:
      return above;
    case kBelow | kAbove:
      return below || above || excluded.contains(bound);
    default:
      return relation == (kBelow | kEven | kAbove);
  }
}

void Facts::Add(FormulaId id) {
  if (contradiction_) return;
  const Formula f = normal_->formula(id);
  switch (f.kind) {
    case Formula::Kind::kTrue:
      return;
    case Formula::Kind::kFalse:
      contradiction_ = true;
      return;
    case Formula::Kind::kLiteral:
      return AddLiteral(f);
    case Formula::Kind::kAnd:
      for (const FormulaId part : f.parts) Add(part);
      return;
    case Formula::Kind::kOr:
      formulas_.insert(id);
      return;
  }
}

void Facts::AddComparison(PolyId poly, uint8_t relation, const Rational& bound) {
  Add(normal_->Literal(Normal::Minus(normal_->poly(poly), Normal::ConstantPoly(bound)), relation));
}

void Facts::AddLiteral(const Formula& literal) {
  if (defined_.insert(literal.poly).second) Defined(literal.poly);
  Range& range = ranges_[literal.poly];
  if (!range.Add(literal.relation, literal.bound)) return;
  Follow(literal.poly);
}

void Facts::Follow(PolyId poly) {
  Range& range = ranges_[poly];
  const AtomId single = normal_->Single(normal_->poly(poly));
  const Atom* atom = single.valid() ? &normal_->atom(single) : nullptr;
  if (atom != nullptr && atom->integral) {
    while (range.lo && range.lo_strict && !range.IsEmpty()) {
      range.lo = range.lo->Floor() + Rational(1);
      range.lo_strict = range.excluded.contains(*range.lo);
    }
    while (range.hi && range.hi_strict && !range.IsEmpty()) {
      range.hi = range.hi->IsInteger() ? *range.hi - Rational(1) : range.hi->Floor();
      range.hi_strict = range.excluded.contains(*range.hi);
    }
  }
  if (range.IsEmpty()) {
    contradiction_ = true;
    return;
  }
  // A root is at most c: it is not less than 0, and its argument is at most c^2.
  if (atom == nullptr || atom->kind != Atom::Kind::kFunction || atom->function != Elementary::kSqrt) return;
  const PolyId argument = atom->args[0];
  const Range known = range;
  const Rational zero(0);
  if (known.hi && (*known.hi < zero || (known.hi->IsZero() && known.hi_strict))) {
    contradiction_ = true;
    return;
  }
  const auto bound = [&](const Rational& c, bool strict, uint8_t side) {
    if (c.Digits() > kMostDigits) return;  // squares of squares of squares
    AddComparison(argument, static_cast<uint8_t>(side | (strict ? 0 : kEven)), c * c);
  };
  if (known.hi) bound(*known.hi, known.hi_strict, kBelow);
  if (known.lo && *known.lo >= zero) bound(*known.lo, known.lo_strict, kAbove);
}

// Arguments of partial functions, wherever their values are needed.
void Facts::Defined(PolyId id) {
  const Poly p = normal_->poly(id);
  for (const auto& [m, c] : p) {
    for (const AtomId a : m) {
      const Atom atom = normal_->atom(a);
      if (atom.kind != Atom::Kind::kFunction && atom.kind != Atom::Kind::kQuotient) continue;
      for (const PolyId arg : atom.args) {
        if (defined_.insert(arg).second) Defined(arg);
      }
      if (atom.kind != Atom::Kind::kFunction) continue;
      const PolyId arg = atom.args[0];
      if (atom.function == Elementary::kSqrt) AddComparison(arg, kAbove | kEven, Rational(0));
      if (atom.function == Elementary::kLog) AddComparison(arg, kAbove, Rational(0));
      if (atom.function != Elementary::kAsin && atom.function != Elementary::kAcos) continue;
      AddComparison(arg, kAbove | kEven, Rational(-1));
      AddComparison(arg, kBelow | kEven, Rational(1));
    }
  }
}

bool Facts::Known(FormulaId id) const {
  if (contradiction_ || formulas_.contains(id)) return true;
  const Formula& f = normal_->formula(id);
  switch (f.kind) {
    case Formula::Kind::kTrue:
      return true;
    case Formula::Kind::kFalse:
      return false;
    case Formula::Kind::kLiteral: {
      const auto it = ranges_.find(f.poly);
      return it != ranges_.end() && it->second.Implies(f.relation, f.bound);
    }
    case Formula::Kind::kAnd:
      return std::ranges::all_of(f.parts, [this](FormulaId p) { return Known(p); });
    case Formula::Kind::kOr:
      return std::ranges::any_of(f.parts, [this](FormulaId p) { return Known(p); });
  }
  return false;
}

void Facts::AddWindow(AtomId variable, const Rational& lo, const Rational& hi) {
  const Atom& atom = normal_->atom(variable);
  if (atom.kind != Atom::Kind::kVariable || atom.integral)
    throw Rejection("only a real variable has a period");
  Periodic periodic(*normal_, variable);
  for (const auto& [poly, range] : ranges_) {
    if (normal_->Single(normal_->poly(poly)) != variable) {
      if (!periodic.Look(poly)) throw Rejection("the variable occurs outside sines and cosines");
      continue;
    }
    const bool both = range.lo && range.hi;
    const bool outside = (range.lo && lo < *range.lo) || (range.hi && hi > *range.hi);
    if (both || outside || !range.excluded.empty())
      throw Rejection("what is known of the variable itself leaves no window");
  }
  for (const FormulaId f : formulas_) {
    if (!periodic.Look(f)) throw Rejection("the variable occurs outside sines and cosines");
  }
  // Full turns are irrational: a window as wide as a number above is wider, which leaves room for strict
  // bounds.
  static const Rational kMoreThanTwoPi = *Rational::Parse("6.2831853071796");  // 2 pi = 6.28318530717958...
  if (hi - lo < periodic.turns() * kMoreThanTwoPi) throw Rejection("the window is narrower than a period");
  const Poly x{{Monomial{variable}, Rational(1)}};
  Add(normal_->Literal(Normal::Minus(x, Normal::ConstantPoly(lo)), kAbove | kEven));
  Add(normal_->Literal(Normal::Minus(x, Normal::ConstantPoly(hi)), kBelow | kEven));
}

void Facts::Substitute(AtomId variable, PolyId value) {
  const Poly x{{Monomial{variable}, Rational(1)}};
  if (!Known(normal_->Literal(Normal::Minus(x, normal_->poly(value)), kEven)))
    throw Rejection("it is not known that the variable has this value");
  Normal::Substitution map(*normal_, variable, value);
  Facts result(*normal_);
  result.contradiction_ = contradiction_;
  const auto add = [&](PolyId poly, uint8_t relation, const Rational& bound) {
    const Poly difference = Normal::Minus(normal_->poly(poly), Normal::ConstantPoly(bound));
    result.Add(map.Apply(normal_->Literal(difference, relation)));
  };
  for (const auto& [poly, range] : ranges_) {
    if (range.lo) add(poly, static_cast<uint8_t>(kAbove | (range.lo_strict ? 0 : kEven)), *range.lo);
    if (range.hi) add(poly, static_cast<uint8_t>(kBelow | (range.hi_strict ? 0 : kEven)), *range.hi);
    for (const Rational& e : range.excluded) add(poly, kBelow | kAbove, e);
  }
  for (const FormulaId f : formulas_) result.Add(map.Apply(f));
  *this = std::move(result);
}

}  // namespace rondo::solve::certify
