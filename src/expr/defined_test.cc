#include "expr/defined.h"

#include <gtest/gtest.h>

#include "expr/import.h"
#include "expr/numeric.h"

namespace rondo::expr {
namespace {

class Terms : public testing::Test {
 protected:
  TermId Number(int64_t n) { return arena.Number(arena.Real(), Rational(n)); }
  TermId Root(TermId t) { return arena.Apply(Elementary::kSqrt, {t}); }
  double Miss(TermId formula, double value) { return Numeric(arena, {{x, value}}).Violation(formula); }

  Arena arena;
  TermId x = arena.Variable(arena.Declare("x", {}, arena.Real()));
};

TEST_F(Terms, WithoutPartialFunctionsTheComplementIsTheNegation) {
  const TermId f = arena.And(arena.Lt(x, Number(1)), arena.Le(Number(0), x));
  EXPECT_EQ(Undefined(arena, f), arena.False());
  EXPECT_EQ(Complement(arena, f), arena.Not(f));
}

// Wherever a formula is not true, be it undefined, its complement is.
TEST_F(Terms, TheComplementHoldsWhereTheFormulaDoesNot) {
  const TermId atom = arena.Lt(Root(x), Number(1));
  const TermId both = arena.And(atom, arena.Le(Number(-3), x));
  const TermId either = arena.Or(arena.Not(atom), arena.Eq(x, Number(-2)));
  for (const double value : {-4.0, -2.0, -1.0, 0.25, 0.5, 4.0}) {
    for (const TermId f : {atom, arena.Not(atom), both, either}) {
      const bool holds = Miss(f, value) == 0;
      EXPECT_EQ(Miss(Complement(arena, f), value) == 0, !holds) << value;
    }
  }
}

TEST_F(Terms, NestedFunctionsAreDefinedFromTheInside) {
  const TermId t = arena.Apply(Elementary::kLog, {arena.Sub(Root(x), Number(1))});
  const TermId undefined = Undefined(arena, t);
  EXPECT_EQ(Miss(undefined, -1), 0);
  EXPECT_EQ(Miss(undefined, 1), 0);
  EXPECT_GT(Miss(undefined, 4), 0);
}

TEST_F(Terms, ACopyMeansTheSame) {
  const TermId f =
      arena.Or(arena.Lt(Root(arena.Mul(x, x)), Number(2)), arena.Eq(arena.Divide(x, Number(3)), Number(5)));
  Arena other;
  Importer import(arena, other);
  const TermId g = import(f);
  EXPECT_EQ(g, import(f));
  const TermId y = other.Variable(other.Declare("x", {}, other.Real()));
  for (const double value : {-3.0, -1.0, 0.0, 1.5, 15.0, 16.0})
    EXPECT_EQ(Miss(f, value) == 0, Numeric(other, {{y, value}}).Violation(g) == 0) << value;
}

}  // namespace
}  // namespace rondo::expr
