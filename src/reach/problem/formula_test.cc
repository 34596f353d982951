#include "reach/problem/formula.h"

#include <gtest/gtest.h>

#include "reach/problem/bounds.h"
#include "reach/problem/numeric.h"
#include "verdict/truth.h"

namespace rondo::reach {
namespace {

using expr::Elementary;

class Formulas : public testing::Test {
 protected:
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  verdict::Truth On(TermId formula, interval::Box box) {
    auto normal = Normalise(arena_, formula);
    EXPECT_TRUE(normal.ok());
    auto terms = Compile(arena_, {x_, y_}, normal.value().terms);
    EXPECT_TRUE(terms.ok());
    return CheckBox(terms.value(), normal.value(), box);
  }

  expr::Arena arena_;
  TermId x_ = Var("x"), y_ = Var("y");
};

TEST_F(Formulas, StrictAndNot) {
  EXPECT_EQ(On(arena_.Le(x_, Num("1")), {{0, 0.999}, {0, 0}}), verdict::Truth::kTrue);
  EXPECT_EQ(On(arena_.Lt(x_, Num("1")), {{0, 1}, {0, 0}}), verdict::Truth::kOpen);
  EXPECT_EQ(On(arena_.Lt(x_, Num("1")), {{1.001, 2}, {0, 0}}), verdict::Truth::kFalse);
  EXPECT_EQ(On(arena_.Not(arena_.Eq(x_, Num("1"))), {{2, 3}, {0, 0}}), verdict::Truth::kTrue);
}

TEST_F(Formulas, UndefinedTermsMakeAtomsFalse) {
  const TermId root = arena_.Apply(Elementary::kSqrt, {x_});
  EXPECT_EQ(On(arena_.Lt(root, Num("2")), {{-2, -1}, {0, 0}}), verdict::Truth::kFalse);
  EXPECT_EQ(On(arena_.Lt(root, Num("2")), {{-1, 1}, {0, 0}}), verdict::Truth::kOpen);
  EXPECT_EQ(On(arena_.Lt(root, Num("2")), {{0, 1}, {0, 0}}), verdict::Truth::kTrue);
  EXPECT_EQ(On(arena_.Not(arena_.Lt(root, Num("2"))), {{-2, -1}, {0, 0}}), verdict::Truth::kFalse);
}

TEST_F(Formulas, LargerAndSmallerAreTakenApart) {
  // x <= max(x, y), though the intervals overlap.
  EXPECT_EQ(On(arena_.Le(x_, arena_.Apply(Elementary::kMax, {x_, y_})), {{0, 1}, {0, 1}}),
            verdict::Truth::kTrue);
  EXPECT_EQ(On(arena_.Le(x_, arena_.Ite(arena_.Le(x_, y_), y_, x_)), {{0, 1}, {0, 1}}),
            verdict::Truth::kTrue);
  EXPECT_EQ(On(arena_.Le(arena_.Apply(Elementary::kAbs, {x_}), Num("1")), {{-0.999, 0.999}, {0, 0}}),
            verdict::Truth::kTrue);
}

TEST_F(Formulas, ContractsToWhatIsPossible) {
  const TermId disc = arena_.Le(arena_.Add(arena_.Mul(x_, x_), arena_.Mul(y_, y_)), Num("4"));
  const TermId formula = arena_.And({disc, arena_.Eq(y_, Num("0.5"))});
  auto normal = Normalise(arena_, formula);
  auto terms = Compile(arena_, {x_, y_}, normal.value().terms);
  interval::Box box{{-1e9, 1e9}, {}};
  Contract(arena_, terms.value(), normal.value(), box);
  EXPECT_TRUE(box[0].Contains(interval::Interval{-1.93, 1.93}));
  EXPECT_LT(box[0].Width(), 4.2);
  EXPECT_EQ(box[1], interval::Interval::Point(0.5));
  const auto pinned = Pinned(arena_, terms.value(), normal.value());
  ASSERT_TRUE(pinned[1]);
  EXPECT_FALSE(pinned[0]);
}

TEST_F(Formulas, ImpossibleIsEmpty) {
  auto normal = Normalise(arena_, arena_.And({arena_.Lt(x_, Num("0")), arena_.Lt(Num("1"), x_)}));
  auto terms = Compile(arena_, {x_, y_}, normal.value().terms);
  interval::Box box{{-5, 5}, {0, 0}};
  Contract(arena_, terms.value(), normal.value(), box);
  EXPECT_TRUE(box[0].IsEmpty());
}

TEST_F(Formulas, SamplesAreBeforeTheHorizon) {
  Problem problem;
  problem.controller = Controller{*Rational::Parse("0.1"), {}};
  problem.horizon = *Rational::Parse("0.5");
  EXPECT_EQ(Samples(problem), 5u);
  problem.horizon = *Rational::Parse("0.3");
  EXPECT_EQ(Samples(problem), 3u);
  problem.horizon = *Rational::Parse("0.31");
  EXPECT_EQ(Samples(problem), 4u);
}

}  // namespace
}  // namespace rondo::reach
