#include "solve/icp/tape/contractor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "expr/numeric.h"
#include "solve/icp/prepare/real_variables_test.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;
using Box = std::array<double, 4>;

class Contraction : public RealVariables {
 protected:
  // Nothing is prepared: the formulas as they are. Both variables occur.
  Tape TapeOf(const std::vector<TermId>& formulas) {
    Prepared prepared;
    prepared.disjunctions = {arena_.Or(arena_.Le(x_, Number("1000")), arena_.Le(y_, Number("1000")))};
    prepared.disjunctions.insert(prepared.disjunctions.end(), formulas.begin(), formulas.end());
    return BuildTape(arena_, variables_, prepared);
  }
  // From bounds of x and y to those of the variables of the tape, and back.
  Box Ordered(const Tape& tape, const Box& box) const {
    EXPECT_EQ(tape.variables.size(), 2u);
    return tape.variables[0].term == x_ ? box : Box{box[2], box[3], box[0], box[1]};
  }
  // What is left of the box; the lanes beside it hold other boxes.
  std::optional<Box> Contracted(const Tape& tape, const Box& box, int lane = 0, int sweeps = 5) {
    Contractor contractor(tape, interval::BestKernels());
    for (int l = 0; l < kLanes; ++l)
      contractor.Load(l, Ordered(tape, l == lane ? box : Box{-0.1 * l, 7.0 + l, -3, 0.3 * l}).data());
    const Lanes alive = contractor.Contract(sweeps);
    if ((alive >> lane & 1) == 0) return std::nullopt;
    Box result;
    contractor.Store(lane, result.data());
    return Ordered(tape, result);
  }
  std::optional<Box> Contracted(const std::vector<TermId>& formulas, const Box& box) {
    return Contracted(TapeOf(formulas), box);
  }
  std::vector<TermId> Formulas() {
    Arena& a = arena_;
    const TermId xx = a.Mul(x_, x_), yy = a.Mul(y_, y_), xy = a.Mul(x_, y_), one = Number("1");
    return {a.Le(a.Add(xx, yy), one),
            a.Le(one, xy),
            a.Eq(a.Add(x_, y_), Number("0.5")),
            a.And(a.Le(Call(Elementary::kSin, x_), Number("-0.5")), a.Le(yy, a.Neg(x_))),
            a.Le(Call(Elementary::kSqrt, a.Sub(x_, y_)), Number("0.5")),
            a.Or(a.Le(xx, Number("0.25")), a.Le(Number("1.5"), a.Mul(x_, yy))),
            a.Le(Call(Elementary::kExp, xy), Number("0.5")),
            a.Le(Number("0.3"), Call(Elementary::kLog, y_)),
            a.Le(a.Ite(a.Lt(x_, y_), a.Sub(y_, x_), xy), Number("0.2")),
            a.Le(Call(Elementary::kAbs, a.Add(x_, one)), Number("0.5")),
            a.Le(Call(Elementary::kCos, xy), Number("-0.2")),
            a.Lt(a.Apply(Elementary::kMax, {x_, y_}), a.Neg(xx)),
            a.Not(a.Eq(a.Mul(xx, x_), Number("-8"))),
            a.Le(Call(Elementary::kAtan, a.Divide(x_, a.Add(yy, one))), Number("-0.4"))};
  }

  using Arena = expr::Arena;
  const TermId x_ = Variable("x", icp::Variable::Kind::kReal), y_ = Variable("y", icp::Variable::Kind::kReal);
  static constexpr Box kBox{-2, 2, -2, 2};
};

TEST_F(Contraction, KeepsEverySolution) {
  const std::vector<TermId> formulas = Formulas();
  for (size_t f = 0; f < formulas.size(); ++f) {
    const auto left = Contracted({formulas[f]}, kBox);
    ASSERT_TRUE(left.has_value()) << f;
    int solutions = 0;
    for (double x = -2; x <= 2; x += 0.125) {
      for (double y = -2; y <= 2; y += 0.125) {
        if (expr::Numeric(arena_, {{x_, x}, {y_, y}}).Violation(formulas[f]) != 0) continue;
        ++solutions;
        EXPECT_TRUE((*left)[0] <= x && x <= (*left)[1] && (*left)[2] <= y && y <= (*left)[3])
            << f << " at " << x << " " << y;
      }
    }
    EXPECT_GT(solutions, 0) << f;
  }
}

TEST_F(Contraction, NeverWidens) {
  for (const TermId f : Formulas()) {
    for (const Box& box : {kBox, Box{-1, 0.5, 0.25, 2}, Box{0, 0, -1, 1}}) {
      const auto left = Contracted({f}, box);
      if (!left) continue;
      EXPECT_TRUE(box[0] <= (*left)[0] && (*left)[1] <= box[1]);
      EXPECT_TRUE(box[2] <= (*left)[2] && (*left)[3] <= box[3]);
    }
  }
}

TEST_F(Contraction, EmptiesBoxesWithoutSolutions) {
  const TermId xx = arena_.Mul(x_, x_), xy = arena_.Mul(x_, y_), one = Number("1");
  EXPECT_FALSE(Contracted({arena_.Le(xx, Number("-0.001"))}, kBox));
  EXPECT_FALSE(Contracted({arena_.Lt(one, Call(Elementary::kSin, xy))}, kBox));
  EXPECT_FALSE(Contracted({arena_.Le(one, xy)}, {-2, -1, 0.5, 2}));
  EXPECT_FALSE(Contracted({arena_.Lt(x_, one), arena_.Le(one, x_)}, kBox));
  EXPECT_FALSE(Contracted({arena_.Or(arena_.Lt(x_, one), arena_.Lt(y_, one))}, {1, 2, 1, 2}));
  EXPECT_FALSE(Contracted({arena_.False()}, kBox));
}

TEST_F(Contraction, EquationsNarrowToTheirSolution) {
  const auto left = Contracted({arena_.Eq(arena_.Mul(Number("2"), x_), Number("3"))}, kBox);
  ASSERT_TRUE(left.has_value());
  EXPECT_NEAR((*left)[0], 1.5, 1e-12);
  EXPECT_NEAR((*left)[1], 1.5, 1e-12);
  EXPECT_EQ((*left)[2], -2);
}

TEST_F(Contraction, TheOnlyPossibleAlternativeIsDemanded) {
  const TermId f = arena_.Or(arena_.Lt(arena_.Mul(x_, x_), Number("-1")), arena_.Le(y_, Number("0.5")));
  EXPECT_LE(Contracted({f}, kBox).value()[3], 0.5);
}

TEST_F(Contraction, AnAlternativeAmongOthersIsNot) {
  const TermId f = arena_.Or(arena_.Lt(x_, Number("0")), arena_.Le(y_, Number("0.5")));
  EXPECT_EQ(Contracted({f}, kBox).value(), kBox);
}

TEST_F(Contraction, NothingHoldsOfWhatIsUndefined) {
  const TermId root = Call(Elementary::kSqrt, x_);
  const Box negative{-2, -1, -2, 2};
  EXPECT_FALSE(Contracted({arena_.Le(root, Number("5"))}, negative));
  EXPECT_FALSE(Contracted({arena_.Not(arena_.Eq(root, Number("5")))}, negative));
  EXPECT_GE(Contracted({arena_.Le(root, Number("5"))}, kBox).value()[0], 0);
}

TEST_F(Contraction, DomainsBindOnlyWhereTheFormulaMustHold) {
  const TermId f = arena_.Or(arena_.Le(Call(Elementary::kSqrt, x_), Number("1")), arena_.Le(y_, Number("0")));
  EXPECT_EQ(Contracted({f}, kBox).value(), kBox);
  EXPECT_LE(Contracted({f}, {-2, -1, -2, 2}).value()[3], 0);
}

TEST_F(Contraction, BoundsOfIntegersAreRounded) {
  const TermId n = Variable("n", icp::Variable::Kind::kInt);
  Prepared prepared;
  prepared.ranges[n].Add(kGreater | kEqual, -10);
  const Tape tape = BuildTape(arena_, variables_, prepared);
  Contractor contractor(tape, interval::BestKernels());
  const std::array<double, 2> box{-1.5, 2.5};
  for (int l = 0; l < kLanes; ++l) contractor.Load(l, box.data());
  EXPECT_EQ(contractor.Contract(1), 0xff);
  std::array<double, 2> left;
  contractor.Store(5, left.data());
  EXPECT_EQ(left, (std::array<double, 2>{-1, 2}));
}

TEST_F(Contraction, LanesDoNotDependOnEachOther) {
  for (const TermId f : Formulas()) {
    const Tape tape = TapeOf({f});
    for (const Box& box : {kBox, Box{-1, 0.5, 0.25, 2}}) {
      const auto first = Contracted(tape, box, 0);
      for (const int lane : {3, 7}) EXPECT_EQ(Contracted(tape, box, lane), first);
    }
  }
}

TEST_F(Contraction, MoreSweepsDoNotWiden) {
  for (const TermId f : Formulas()) {
    const Tape tape = TapeOf({f});
    const auto once = Contracted(tape, kBox, 0, 1), often = Contracted(tape, kBox, 0, 8);
    if (!often) continue;
    ASSERT_TRUE(once.has_value());
    EXPECT_TRUE((*once)[0] <= (*often)[0] && (*often)[1] <= (*once)[1]);
    EXPECT_TRUE((*once)[2] <= (*often)[2] && (*often)[3] <= (*once)[3]);
  }
}

TEST_F(Contraction, EvaluatingContractsNothing) {
  const Tape tape = TapeOf({arena_.Le(arena_.Mul(x_, x_), Number("0.01"))});
  Contractor contractor(tape, interval::BestKernels());
  for (int l = 0; l < kLanes; ++l) contractor.Load(l, kBox.data());
  EXPECT_EQ(contractor.Evaluate(), 0xff);
  Box left;
  contractor.Store(0, left.data());
  EXPECT_EQ(left, kBox);
}

TEST_F(Contraction, ChoicesFollowTheirConditions) {
  // |x|, written as a choice.
  const TermId size = arena_.Ite(arena_.Lt(x_, Number("0")), arena_.Neg(x_), x_);
  EXPECT_FALSE(Contracted({arena_.Le(size, Number("1"))}, {1.5, 2, -2, 2}));
  EXPECT_FALSE(Contracted({arena_.Le(size, Number("1"))}, {-2, -1.5, -2, 2}));
  EXPECT_GE(Contracted({arena_.Le(size, Number("1"))}, {-2, -0.5, -2, 2}).value()[0], -1.0000001);
}

TEST_F(Contraction, OpenAreThoseThatAreNotDecided) {
  const Tape tape = TapeOf({arena_.Or(arena_.Le(x_, Number("1")), arena_.Le(y_, Number("0")))});
  const auto at = std::ranges::find(tape.thresholds, Rational(1), &Threshold::value);
  ASSERT_NE(at, tape.thresholds.end());
  Contractor contractor(tape, interval::BestKernels());
  for (int l = 0; l < kLanes; ++l) {
    contractor.Load(l, Ordered(tape, {0, l == 0 ? 0.5 : 1.5, -2, 2}).data());
  }
  contractor.Contract(1);
  std::vector<Lanes> open;
  contractor.Open(open);
  const Lanes undecided = open[static_cast<size_t>(at - tape.thresholds.begin())];
  EXPECT_EQ(undecided & 1, 0);
  EXPECT_NE(undecided & 2, 0);
}

}  // namespace
}  // namespace rondo::solve::icp
