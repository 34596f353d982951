#include "solve/icp/prepare/rotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "expr/numeric.h"
#include "expr/polynomial.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;
using expr::Rational;
using expr::TermId;

class Turned : public testing::Test {
 protected:
  TermId Number(int n) { return arena_.Number(arena_.Real(), Rational(n)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Cos(TermId t) { return arena_.Apply(Elementary::kCos, {t}); }
  TermId Sin(TermId t) { return arena_.Apply(Elementary::kSin, {t}); }
  // The coordinates of (a, b) in a frame that is turned by `angle`.
  std::array<TermId, 2> In(TermId angle, TermId a, TermId b) {
    return {arena_.Add(arena_.Mul(a, Cos(angle)), arena_.Mul(b, Sin(angle))),
            arena_.Sub(arena_.Mul(b, Cos(angle)), arena_.Mul(a, Sin(angle)))};
  }
  TermId Both(const std::array<TermId, 2>& v) {
    return arena_.And(arena_.Le(v[0], Number(1)), arena_.Le(v[1], Number(2)));
  }
  std::vector<expr::Numeric::Point> Points() {
    std::vector<expr::Numeric::Point> points;
    for (int i = 0; i < 40; ++i) {
      points.push_back({{x_, 0.37 * i - 4}, {y_, 2 - 0.21 * i}, {u_, 0.61 * i - 7}, {w_, 3 - 0.43 * i}});
    }
    return points;
  }
  void ExpectLemmasHold(const std::vector<Lemma>& lemmas) {
    for (const auto& point : Points()) {
      expr::Numeric numeric(arena_, point);
      for (const Lemma& lemma : lemmas) {
        double sum = lemma.constant.ToDouble();
        for (const auto& [factor, term] : lemma.parts) sum += factor.ToDouble() * numeric(term);
        EXPECT_NEAR(sum, 0, 1e-9);
      }
    }
  }

  expr::Arena arena_;
  const TermId x_ = Variable("x"), y_ = Variable("y"), u_ = Variable("u"), w_ = Variable("w");
};

TEST_F(Turned, RewritingKeepsMeaning) {
  const auto [p, q] = In(u_, arena_.Add(x_, Number(3)), arena_.Mul(Number(2), y_));
  for (const TermId f : {Both({p, q}), arena_.Le(arena_.Add({arena_.Mul(Number(-3), p), q, x_}), Number(0)),
                         arena_.Le(arena_.Add(arena_.Mul(p, p), arena_.Mul(q, q)), Number(4)),
                         Both(In(w_, arena_.Add(p, Number(1)), q))}) {
    Rotations rotations(arena_);
    const TermId rewritten = rotations.Rewrite(f);
    for (const auto& point : Points()) {
      EXPECT_NEAR(expr::Numeric(arena_, point).Violation(f),
                  expr::Numeric(arena_, point).Violation(rewritten), 1e-9);
    }
  }
}

TEST_F(Turned, RotationsKeepLengths) {
  Rotations rotations(arena_);
  rotations.Rewrite(Both(In(u_, x_, y_)));
  const std::vector<Lemma> lemmas = rotations.Lemmas();
  ASSERT_EQ(lemmas.size(), 1u);
  ExpectLemmasHold(lemmas);
}

TEST_F(Turned, ScaledVectorsAreOneVector) {
  Rotations rotations(arena_);
  const auto [p, q] = In(u_, x_, y_);
  rotations.Rewrite(Both({arena_.Mul(Number(3), p), arena_.Mul(Number(-5), q)}));
  const std::vector<Lemma> lemmas = rotations.Lemmas();
  ASSERT_EQ(lemmas.size(), 1u);
  ExpectLemmasHold(lemmas);
}

TEST_F(Turned, OneCoordinateAloneSaysNothing) {
  Rotations rotations(arena_);
  rotations.Rewrite(arena_.Le(In(u_, x_, y_)[0], Number(1)));
  EXPECT_TRUE(rotations.Lemmas().empty());
}

TEST_F(Turned, FramesOfAChainAreTied) {
  Rotations rotations(arena_);
  const auto [p, q] = In(u_, x_, y_);
  rotations.Rewrite(arena_.And(Both({p, q}), Both(In(w_, arena_.Add(p, Number(2)), q))));
  const std::vector<Lemma> lemmas = rotations.Lemmas();
  EXPECT_TRUE(std::ranges::any_of(lemmas, [](const Lemma& l) { return l.parts.size() == 3; }));
  ExpectLemmasHold(lemmas);
}

// What is left of the length of a vector in a chain of frames once one coordinate in the last frame is taken away, with
// everything multiplied out: the square of the other coordinate.
TEST_F(Turned, LengthsAreFollowedThroughTheFrames) {
  const TermId p = In(u_, x_, y_)[0];
  const TermId q = In(u_, x_, y_)[1];
  const TermId last = In(w_, arena_.Add(p, Number(2)), q)[0];
  const TermId along = ToTerm(arena_, Expand(arena_, last, 100).value());
  const TermId length =
      arena_.Add({arena_.Mul(x_, x_), arena_.Mul(y_, y_), Number(4), arena_.Mul(Number(4), p)});
  const TermId rest = arena_.Sub(length, arena_.Mul(along, along));
  Rotations rotations(arena_);
  rotations.Rewrite(arena_.And(arena_.Le(along, Number(1)), arena_.Le(rest, Number(2))));
  const std::vector<Lemma> links = rotations.Links();
  ExpectLemmasHold(links);
  ExpectLemmasHold(rotations.Lemmas());
  const auto is_square = [&](const Lemma& link) {
    const TermId t = link.parts.back().second;
    return link.parts.size() == 2 && link.constant.IsZero() && arena_.op(t) == expr::Op::kMul &&
           arena_.arg(t, 0) == arena_.arg(t, 1);
  };
  EXPECT_TRUE(std::ranges::any_of(links, is_square));
}

TEST_F(Turned, WhatIsTurnedByOneAngleTwiceIsAVector) {
  const TermId c = Cos(u_), s = Sin(u_);
  const TermId twice = arena_.Sub(arena_.Mul(c, c), arena_.Mul(s, s));
  const TermId f =
      arena_.Add({arena_.Mul(x_, twice), arena_.Mul(Number(2), arena_.Mul(y_, arena_.Mul(s, c))), w_});
  Rotations rotations(arena_);
  rotations.Rewrite(arena_.Le(f, Number(1)));
  const std::vector<Lemma> links = rotations.Links();
  ASSERT_EQ(links.size(), 1U);
  EXPECT_EQ(links[0].parts.size(), 3U);  // the sum, one coordinate, w
  ExpectLemmasHold(links);
  ExpectLemmasHold(rotations.Lemmas());
}

TEST_F(Turned, AngleSumsAreNoVectors) {
  Rotations rotations(arena_);
  const TermId sum = arena_.Sub(arena_.Mul(Cos(u_), Cos(w_)), arena_.Mul(Sin(u_), Sin(w_)));
  rotations.Rewrite(arena_.Le(arena_.Add(sum, x_), Number(1)));
  EXPECT_TRUE(rotations.Links().empty());
}

TEST_F(Turned, PartialFunctionsStayAsTheyAre) {
  Rotations rotations(arena_);
  const TermId root = arena_.Apply(Elementary::kSqrt, {x_});
  const TermId f = Both(In(u_, root, y_));
  EXPECT_EQ(rotations.Rewrite(f), f);
  EXPECT_TRUE(rotations.Lemmas().empty());
}

TEST_F(Turned, NumbersTimesWavesAreNoVector) {
  Rotations rotations(arena_);
  rotations.Rewrite(arena_.Le(arena_.Add(Cos(u_), arena_.Mul(x_, Cos(w_))), Number(1)));
  EXPECT_TRUE(rotations.Lemmas().empty());
}

}  // namespace
}  // namespace rondo::solve::icp
