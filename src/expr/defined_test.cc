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

// What is simplified away keeps where it has a value.
TEST_F(Terms, NothingWithoutAValueIsSimplifiedAway) {
  const TermId root = Root(x);
  const TermId log = arena.Apply(Elementary::kLog, {x});
  const TermId zero = Number(0);
  for (const TermId gone :
       {arena.Mul(zero, root), arena.Sub(root, root), arena.Mul(zero, arena.Add(arena.Mul(x, root), x)),
        arena.Add({arena.Mul(Number(2), root), arena.Mul(Number(-2), root)}),
        arena.Sub(arena.Mul(zero, root), arena.Mul(zero, root))}) {
    EXPECT_TRUE(arena.IsPartial(gone));
    EXPECT_EQ(Miss(arena.Eq(gone, zero), 2), 0);
    EXPECT_GT(Miss(arena.Eq(gone, zero), -2), 0);
    EXPECT_GT(Miss(arena.Not(arena.Eq(gone, zero)), -2), 0);
    EXPECT_EQ(arena.Sub(gone, gone), gone);
  }
  for (const TermId formula : {arena.Le(root, root), arena.Lt(root, arena.Add(root, Number(1))),
                               arena.Eq(root, root), arena.Le(arena.Add(x, root), arena.Add(root, x))}) {
    EXPECT_EQ(Miss(formula, 2), 0);
    EXPECT_GT(Miss(formula, -2), 0);
  }
  // Neither a comparison without a value nor its negation holds.
  for (const TermId formula :
       {arena.Lt(root, arena.Sub(root, Number(1))), arena.Lt(log, arena.Sub(log, Number(1)))}) {
    EXPECT_GT(Miss(formula, 2), 0);
    EXPECT_EQ(Miss(arena.Not(formula), 2), 0);
    EXPECT_GT(Miss(formula, -2), 0);
    EXPECT_GT(Miss(arena.Not(formula), -2), 0);
  }
  const TermId one = arena.Eq(root, Number(1));
  EXPECT_GT(Miss(arena.Or(one, arena.Not(one)), -2), 0);
  EXPECT_EQ(arena.And(one, arena.Not(one)), arena.False());
  // Without such parts, nothing changes.
  EXPECT_EQ(arena.Mul(zero, x), zero);
  EXPECT_EQ(arena.Le(x, x), arena.True());
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
