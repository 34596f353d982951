#include "robot/values/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "expr/numeric.h"

namespace rondo::robot {
namespace {

using expr::Rational;

class Poses : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Vector At(const char* x, const char* y, const char* z) { return {Number(x), Number(y), Number(z)}; }
  // Right angles.
  TermId Quarters(const char* n) { return arena_.Mul(Number(n), arena_.Mul(Number("0.5"), Pi(arena_))); }
  double Value(TermId t) { return expr::Numeric(arena_, {{u_, 0.7}, {w_, -2.3}})(t); }
  void ExpectEqual(const Vector& a, const Vector& b) {
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(Value(a[i]), Value(b[i]), 1e-12) << i;
  }
  void ExpectEqual(const Pose& a, const Pose& b) {
    ExpectEqual(a.origin, b.origin);
    for (size_t i = 0; i < 3; ++i) ExpectEqual(a.rotation[i], b.rotation[i]);
  }
  // Frames of every kind.
  std::vector<Pose> Some() {
    std::vector<Pose> all{Translation(arena_, {u_, Number("2"), w_}), Rotation(arena_, 0, u_),
                          Rotation(arena_, 1, w_), Rotation(arena_, 2, arena_.Add(u_, Number("1")))};
    all.push_back(Compose(arena_, Compose(arena_, all[0], all[3]), all[1]));
    return all;
  }

  Arena arena_;
  const TermId u_ = Variable("u"), w_ = Variable("w");
  const Vector p_ = At("3", "-1", "0.5");
};

TEST_F(Poses, AxesAreOrthonormalAndRightHanded) {
  for (const Pose& pose : Some()) {
    double r[3][3];
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) r[i][j] = Value(pose.rotation[i][j]);
    }
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(r[0][i] * r[0][j] + r[1][i] * r[1][j] + r[2][i] * r[2][j], i == j ? 1 : 0, 1e-12);
      const size_t j = (i + 1) % 3, k = (i + 2) % 3;
      EXPECT_NEAR(r[j][0] * r[k][1] - r[k][0] * r[j][1], r[i][2], 1e-12);
    }
  }
}

TEST_F(Poses, TheIdentityChangesNothing) {
  EXPECT_EQ(ToWorld(arena_, Identity(arena_), p_), p_);
  for (const Pose& pose : Some()) {
    ExpectEqual(Compose(arena_, pose, Identity(arena_)), pose);
    ExpectEqual(Compose(arena_, Identity(arena_), pose), pose);
  }
}

TEST_F(Poses, ThereAndBackIsNoWay) {
  for (const Pose& pose : Some()) {
    ExpectEqual(FromWorld(arena_, pose, ToWorld(arena_, pose, p_)), p_);
    ExpectEqual(ToWorld(arena_, pose, FromWorld(arena_, pose, p_)), p_);
  }
}

TEST_F(Poses, ComposedFramesAreOneAfterTheOther) {
  for (const Pose& a : Some()) {
    for (const Pose& b : Some())
      ExpectEqual(ToWorld(arena_, Compose(arena_, a, b), p_), ToWorld(arena_, a, ToWorld(arena_, b, p_)));
  }
}

TEST_F(Poses, CompositionIsAssociative) {
  const std::vector<Pose> all = Some();
  ExpectEqual(Compose(arena_, all[4], Compose(arena_, all[1], all[0])),
              Compose(arena_, Compose(arena_, all[4], all[1]), all[0]));
}

TEST_F(Poses, RightAnglesAreExactAndRightHanded) {
  const std::array<Vector, 3> x_y_z{At("1", "0", "0"), At("0", "1", "0"), At("0", "0", "1")};
  for (int axis = 0; axis < 3; ++axis) {
    const Pose turn = Rotation(arena_, axis, Quarters("1"));
    const auto i = static_cast<size_t>(axis), j = (i + 1) % 3, k = (i + 2) % 3;
    EXPECT_EQ(ToWorld(arena_, turn, x_y_z[i]), x_y_z[i]);
    EXPECT_EQ(ToWorld(arena_, turn, x_y_z[j]), x_y_z[k]);
  }
}

TEST_F(Poses, WavesOfMultiplesOfARightAngleAreNumbers) {
  const char* sines[] = {"0", "1", "0", "-1"};
  for (int n = -5; n <= 5; ++n) {
    const TermId angle = Quarters(std::to_string(n).c_str());
    EXPECT_EQ(Sin(arena_, angle), Number(sines[(n + 8) % 4])) << n;
    EXPECT_EQ(Cos(arena_, angle), Number(sines[(n + 9) % 4])) << n;
  }
}

TEST_F(Poses, WavesOfSumsWithRightAnglesAreRight) {
  for (const char* n : {"-3", "-1", "1", "2", "3", "0.5", "4/3"}) {
    const TermId angle = arena_.Add(u_, Quarters(n));
    EXPECT_NEAR(Value(Sin(arena_, angle)), std::sin(Value(angle)), 1e-12) << n;
    EXPECT_NEAR(Value(Cos(arena_, angle)), std::cos(Value(angle)), 1e-12) << n;
  }
}

TEST_F(Poses, PiIsHalfATurn) { EXPECT_NEAR(Value(Pi(arena_)), std::numbers::pi, 1e-15); }

TEST_F(Poses, NumbersAndMultiplesOfPiAreCompared) {
  const TermId pi = Pi(arena_);
  EXPECT_TRUE(IsBelow(arena_, Number("1"), Number("2")));
  EXPECT_FALSE(IsBelow(arena_, Number("2"), Number("2")));
  EXPECT_TRUE(IsBelow(arena_, Number("3.14159265358979"), pi));
  EXPECT_TRUE(IsBelow(arena_, pi, Number("3.14159265358980")));
  EXPECT_FALSE(IsBelow(arena_, pi, Number("3.14159265358979")));
  EXPECT_TRUE(IsBelow(arena_, arena_.Neg(pi), arena_.Mul(Number("-0.999"), pi)));
  EXPECT_FALSE(IsBelow(arena_, pi, pi));
}

TEST_F(Poses, OfVariablesNothingIsCertain) {
  EXPECT_FALSE(IsBelow(arena_, u_, w_));
  EXPECT_TRUE(IsBelow(arena_, u_, arena_.Add(u_, Number("1"))));
}

}  // namespace
}  // namespace rondo::robot
