#include "reach/problem/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "reach/problem/bounds.h"
#include "reach/problem/numeric.h"

namespace rondo::reach {
namespace {

using expr::Elementary;

class Programs : public testing::Test {
 protected:
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }
  Program Made(const std::vector<TermId>& functions, size_t core = SIZE_MAX) {
    auto program = Compile(arena_, {x_, y_}, functions, core);
    EXPECT_TRUE(program.ok());
    return std::move(program).value();
  }
  double ValueAt(TermId term, double x, double y) {
    const Program program = Made({term});
    Evaluator evaluate(program);
    double value = 0;
    evaluate(std::vector<double>{x, y}, std::span(&value, 1));
    return value;
  }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
};

TEST(Constants, AreEnclosedByNeighbours) {
  for (const char* text : {"1/3", "-1/3", "0.1", "123456789.123456789", "-1/7000000000000000000000"}) {
    const Rational value = *Rational::Parse(text);
    const Interval i = Enclose(value);
    EXPECT_LT(Rational::FromDouble(i.lo), value) << text;
    EXPECT_LT(value, Rational::FromDouble(i.hi)) << text;
    EXPECT_EQ(std::nextafter(i.lo, INFINITY), i.hi) << text;
  }
}

TEST(Constants, ThatAreDoublesArePoints) {
  for (const double value : {0.0, 0.25, -3.5, 0x1p-1074, 1e300})
    EXPECT_EQ(Enclose(Rational::FromDouble(value)), Interval::Point(value));
}

TEST(Constants, BeyondAllDoublesHaveABoundAtInfinity) {
  const Rational most = Rational::FromDouble(std::numeric_limits<double>::max());
  const Interval i = Enclose(most * Rational(2));
  EXPECT_EQ(i.lo, std::numeric_limits<double>::max());
  EXPECT_TRUE(std::isinf(i.hi));
}

TEST(Constants, AreOffByNoMoreThanTheirErrors) {
  for (const char* text : {"1/3", "-2/7", "0.1", "0.5", "-1e-30"}) {
    const Rational value = *Rational::Parse(text);
    const LinearPart part = NearestConstant(value);
    const Rational off = Rational::FromDouble(part.factor) - value;
    const Rational error = Rational::FromDouble(part.error);
    EXPECT_TRUE(off <= error && Rational(0) - error <= off) << text;
  }
}

TEST(Constants, OfOppositeNumbersAreOpposite) {
  const Rational third = *Rational::Parse("1/3");
  EXPECT_EQ(NearestConstant(third).factor, -NearestConstant(Rational(0) - third).factor);
}

TEST_F(Programs, ComputeElementaryFunctions) {
  const double x = 0.4;
  EXPECT_NEAR(ValueAt(Of(Elementary::kTan, {x_}), x, 0), std::tan(x), 1e-15);
  EXPECT_NEAR(ValueAt(Of(Elementary::kAsin, {x_}), x, 0), std::asin(x), 1e-15);
  EXPECT_NEAR(ValueAt(Of(Elementary::kAcos, {x_}), x, 0), std::acos(x), 1e-15);
  EXPECT_NEAR(ValueAt(Of(Elementary::kCos, {x_}), x, 0), std::cos(x), 1e-15);
  EXPECT_NEAR(ValueAt(Of(Elementary::kLog, {x_}), x, 0), std::log(x), 1e-15);
  EXPECT_NEAR(ValueAt(Of(Elementary::kAtan2, {x_, y_}), x, -1), std::atan2(x, -1), 1e-15);
  EXPECT_EQ(ValueAt(Of(Elementary::kMin, {x_, y_}), x, -1), -1);
  EXPECT_EQ(ValueAt(Of(Elementary::kMax, {x_, y_}), x, -1), x);
}

TEST_F(Programs, ComputePolynomialsAndQuotients) {
  const TermId cubic = arena_.Sub(arena_.Mul(Num("2"), arena_.Mul(x_, arena_.Mul(x_, y_))), Num("0.5"));
  EXPECT_EQ(ValueAt(cubic, 3, -2), -36.5);
  EXPECT_EQ(ValueAt(arena_.Divide(x_, y_), 3, -2), -1.5);
}

TEST_F(Programs, ChooseByConditions) {
  const TermId inside = arena_.And(arena_.Le(Num("0"), x_), arena_.Lt(x_, Num("1")));
  const TermId either = arena_.Or(arena_.Lt(x_, Num("0")), arena_.Eq(x_, Num("1")));
  for (const double x : {-1.0, 0.0, 0.5, 1.0, 2.0}) {
    EXPECT_EQ(ValueAt(arena_.Ite(inside, Num("3"), Num("4")), x, 0), 0 <= x && x < 1 ? 3 : 4) << x;
    EXPECT_EQ(ValueAt(arena_.Ite(either, Num("3"), Num("4")), x, 0), x < 0 || x == 1 ? 3 : 4) << x;
    EXPECT_EQ(ValueAt(arena_.Ite(arena_.Not(inside), Num("3"), Num("4")), x, 0), 0 <= x && x < 1 ? 4 : 3);
  }
}

TEST_F(Programs, HaveArgumentsFirst) {
  const Program p = Made({arena_.Mul(Of(Elementary::kSin, {x_}), y_), Of(Elementary::kAtan, {y_})});
  for (uint32_t n = 0; n < p.code.size(); ++n) {
    const Code& c = p.code[n];
    if (c.op == CodeOp::kVariable) continue;
    if (c.op == CodeOp::kLinear) {
      for (uint32_t i = c.a; i < c.a + c.b; ++i) EXPECT_LT(p.parts[i].node, n);
    } else {
      EXPECT_LT(c.a, n);
    }
  }
}

TEST_F(Programs, ShareWhatIsTheSame) {
  const TermId sine = Of(Elementary::kSin, {arena_.Mul(x_, y_)});
  const Program p = Made({sine, arena_.Add(sine, x_), Of(Elementary::kCos, {arena_.Mul(y_, x_)})});
  EXPECT_EQ(std::ranges::count(p.code, CodeOp::kProduct, &Code::op), 1);
  EXPECT_EQ(std::ranges::count(p.code, CodeOp::kSine, &Code::op), 1);
  EXPECT_EQ(std::ranges::count(p.code, CodeOp::kCosine, &Code::op), 1);
}

TEST_F(Programs, KnowWhatTheyDependOn) {
  const Program p = Made({Of(Elementary::kExp, {y_}), arena_.Mul(x_, y_), Num("3")});
  EXPECT_EQ(p.depends[p.outputs[0]], std::vector<uint32_t>{1});
  EXPECT_EQ(p.depends[p.outputs[1]], (std::vector<uint32_t>{0, 1}));
  EXPECT_TRUE(p.depends[p.outputs[2]].empty());
}

TEST_F(Programs, ListTheirKinks) {
  const Program p = Made({Of(Elementary::kAbs, {x_}), Of(Elementary::kMax, {x_, y_}),
                          arena_.Ite(arena_.Le(x_, y_), x_, y_), Of(Elementary::kExp, {x_})});
  EXPECT_EQ(p.kinks, (std::vector<uint32_t>{p.outputs[0], p.outputs[1], p.outputs[2]}));
}

TEST_F(Programs, KeepTheirCoreInFront) {
  const Program p = Made({arena_.Mul(x_, y_), Of(Elementary::kExp, {x_})}, 1);
  EXPECT_LT(p.outputs[0], p.core_end);
  EXPECT_GE(p.outputs[1], p.core_end);
}

TEST_F(Programs, AreNotMadeOfWhatHasNoDerivative) {
  const TermId n = arena_.Variable(arena_.Declare("n", {}, arena_.Int()));
  EXPECT_FALSE(Compile(arena_, {x_, n}, {arena_.ToReal(arena_.IntDiv(n, arena_.IntNumber(2)))}).ok());
}

TEST_F(Programs, NameVariablesThatAreMissing) {
  const auto program = Compile(arena_, {x_}, {arena_.Add(x_, y_)});
  ASSERT_FALSE(program.ok());
  EXPECT_NE(program.error().message.find("`y`"), std::string::npos);
}

TEST_F(Programs, OnBoxesEncloseTheirValues) {
  const std::vector<TermId> functions{
      arena_.Mul(x_, Of(Elementary::kSin, {y_})), Of(Elementary::kAtan2, {y_, x_}),
      arena_.Ite(arena_.Lt(x_, y_), Of(Elementary::kExp, {x_}), Of(Elementary::kAbs, {y_})),
      arena_.Divide(x_, arena_.Add(arena_.Mul(y_, y_), Num("1")))};
  const Program p = Made(functions);
  const std::vector<Interval> values = ValuesOn(p, {{-1, 0.5}, {-0.5, 2}});
  std::mt19937_64 random(4);
  for (int sample = 0; sample < 100; ++sample) {
    const double x = std::uniform_real_distribution<double>(-1, 0.5)(random);
    const double y = std::uniform_real_distribution<double>(-0.5, 2)(random);
    for (size_t f = 0; f < functions.size(); ++f) {
      const Interval i = values[p.outputs[f]];
      EXPECT_TRUE(Interval({i.lo - 1e-15, i.hi + 1e-15}).Contains(ValueAt(functions[f], x, y))) << f;
    }
  }
}

TEST_F(Programs, AreLinesInAVariable) {
  const auto line = LineIn(arena_, arena_.Sub(arena_.Mul(Num("3"), x_), y_), x_);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->slope, Rational(3));
  EXPECT_EQ(line->rest, arena_.Neg(y_));
}

TEST_F(Programs, AreNoLinesIfCurvedOrConstant) {
  EXPECT_FALSE(LineIn(arena_, arena_.Mul(x_, x_), x_));
  EXPECT_FALSE(LineIn(arena_, y_, x_));
}

TEST_F(Programs, ContractionKeepsEveryPointThatSatisfies) {
  const TermId disc = arena_.Le(arena_.Add(arena_.Mul(x_, x_), arena_.Mul(y_, y_)), Num("1"));
  interval::Box box{{}, {0, 5}};
  ASSERT_TRUE(
      Contract(arena_, arena_.And(disc, arena_.Le(arena_.Mul(Num("3"), y_), Num("1"))), {x_, y_}, box));
  EXPECT_TRUE(box[0].Contains(Interval{-1, 1}));
  EXPECT_LT(box[0].Width(), 2.5);
  EXPECT_EQ(box[1].lo, 0);
  EXPECT_EQ(box[1].hi, Enclose(*Rational::Parse("1/3")).hi);
}

TEST_F(Programs, OnlyWhatMustHoldIsNecessary) {
  const auto formula = Normalise(
      arena_, arena_.And(arena_.Le(x_, Num("1")), arena_.Or(arena_.Le(y_, x_), arena_.Le(x_, Num("-1")))));
  ASSERT_TRUE(formula.ok());
  EXPECT_EQ(Necessary(formula.value()), std::vector<TermId>{arena_.Sub(x_, Num("1"))});
}

}  // namespace
}  // namespace rondo::reach
