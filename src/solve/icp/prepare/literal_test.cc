#include "solve/icp/prepare/literal.h"

#include <gtest/gtest.h>

#include "expr/evaluate.h"

namespace rondo::solve::icp {
namespace {

class Literals : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Times(const char* factor, TermId t) { return arena_.Mul(Number(factor), t); }
  expr::Value At(TermId t, int x, int y) {
    const auto value = [&](TermId v) { return expr::Value{Rational(v == x_ ? x : y)}; };
    return *expr::Evaluate(arena_, t, value);
  }
  std::vector<TermId> Comparisons() {
    const TermId sum = arena_.Add({Times("2", x_), Times("-4", y_), Number("3")});
    const TermId product = arena_.Mul(x_, y_);
    return {arena_.Le(sum, Number("5")),
            arena_.Lt(Number("5"), sum),
            arena_.Eq(sum, Number("1")),
            arena_.Not(arena_.Eq(sum, Number("1"))),
            arena_.Le(Times("-1/2", x_), Number("1")),
            arena_.Lt(y_, x_),
            arena_.Lt(arena_.Neg(product), arena_.Add(x_, Number("1"))),
            arena_.Not(arena_.Eq(product, Number("2")))};
  }

  expr::Arena arena_;
  const TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  const TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
};

TEST_F(Literals, SayTheSameAsTheirFormulas) {
  for (const TermId f : Comparisons()) {
    const auto literal = AsLiteral(arena_, f);
    ASSERT_TRUE(literal.has_value());
    for (int x = -4; x <= 4; ++x) {
      for (int y = -3; y <= 3; ++y) {
        EXPECT_EQ(Holds(At(literal->term, x, y).AsNumber(), literal->relation, literal->bound),
                  At(f, x, y).AsBool());
      }
    }
  }
}

TEST_F(Literals, FormulasOfLiteralsSayTheSame) {
  for (const TermId f : Comparisons()) {
    const TermId again = ToFormula(arena_, *AsLiteral(arena_, f));
    for (int x = -4; x <= 4; ++x) {
      for (int y = -3; y <= 3; ++y) EXPECT_EQ(At(f, x, y), At(again, x, y));
    }
  }
}

TEST_F(Literals, TheSameExpressionHasOneTerm) {
  const auto first = AsLiteral(arena_, arena_.Le(arena_.Sub(Times("2", x_), Times("4", y_)), Number("6")));
  const auto second = AsLiteral(arena_, arena_.Lt(Times("2", y_), arena_.Add(x_, Number("1"))));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->term, second->term);
}

TEST_F(Literals, TermsHaveNoConstantAndBeginWithOne) {
  for (const TermId f : Comparisons()) {
    const TermId term = AsLiteral(arena_, f)->term;
    EXPECT_EQ(At(term, 0, 0).AsNumber(), Rational(0));
    const TermId first = arena_.op(term) == expr::Op::kAdd ? arena_.arg(term, 0) : term;
    EXPECT_FALSE(arena_.op(first) == expr::Op::kMul && arena_.IsNumber(arena_.arg(first, 0)));
  }
}

TEST_F(Literals, OtherFormulasAreNone) {
  const TermId b = arena_.Variable(arena_.Declare("b", {}, arena_.Bool()));
  const TermId f = arena_.Lt(x_, y_), g = arena_.Lt(y_, Number("0"));
  for (const TermId other : {b, arena_.Not(b), arena_.And(f, g), arena_.Or(f, g), arena_.True()})
    EXPECT_FALSE(AsLiteral(arena_, other).has_value());
}

TEST_F(Literals, ComparedNumbersAreLiterals) {
  const TermId f = arena_.Raw(expr::Op::kLt, arena_.Bool(), 0, {Number("1"), Number("2")});
  const auto literal = AsLiteral(arena_, f);
  ASSERT_TRUE(literal && arena_.IsNumber(literal->term));
  EXPECT_TRUE(Holds(arena_.number(literal->term), literal->relation, literal->bound));
}

TEST_F(Literals, EveryRelationHasAFormula) {
  for (Relation r = 0; r < 8; ++r) {
    const TermId f = ToFormula(arena_, {x_, r, Rational(1)});
    for (int x = 0; x <= 2; ++x) EXPECT_EQ(At(f, x, 0).AsBool(), Holds(x, r, 1)) << int{r} << " " << x;
  }
}

TEST_F(Literals, RelationsHoldWhereTheirBitsSay) {
  EXPECT_TRUE(Holds(0, kLess, 1));
  EXPECT_FALSE(Holds(1, kLess, 1));
  EXPECT_TRUE(Holds(1, kEqual, 1));
  EXPECT_TRUE(Holds(2, kGreater, 1));
  EXPECT_FALSE(Holds(2, kLess | kEqual, 1));
  EXPECT_FALSE(Holds(1, kLess | kGreater, 1));
  EXPECT_FALSE(Holds(1, 0, 1));
}

TEST_F(Literals, NormalisingKeepsMeaning) {
  const std::vector<TermId> all = Comparisons();
  const TermId f = arena_.And(arena_.Or(all[0], all[3]), arena_.Or({all[5], all[6], all[4]}));
  const TermId normal = Normalised(arena_, f);
  for (int x = -4; x <= 4; ++x) {
    for (int y = -3; y <= 3; ++y) EXPECT_EQ(At(f, x, y), At(normal, x, y));
  }
}

TEST_F(Literals, NormalisingTwiceChangesNothingMore) {
  for (const TermId f : Comparisons()) {
    const TermId once = Normalised(arena_, f);
    EXPECT_EQ(Normalised(arena_, once), once);
  }
}

}  // namespace
}  // namespace rondo::solve::icp
