#include "robot/separation/set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace rondo::robot {
namespace {

using expr::Rational;

class Sets : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Shape Ball(const char* radius) {
    Shape s;
    s.kind = ShapeKind::kSphere;
    s.frame = Identity(arena_);
    s.sizes = {Number(radius)};
    return s;
  }
  std::optional<std::vector<Piece>> Pieces(std::vector<Shape> shapes, TermId where, size_t most = 100) {
    return PiecesOf(arena_, point_, {arena_.True(), std::move(shapes), where, std::nullopt}, most);
  }
  // The sets of a piece that are no solids.
  static Piece Rest(const Piece& piece) {
    Piece rest;
    for (const Set& s : piece) {
      if (s.kind != SetKind::kSolid) rest.push_back(s);
    }
    return rest;
  }
  Set Only(TermId where) {
    const auto pieces = Pieces({Ball("1")}, where);
    EXPECT_TRUE(pieces && pieces->size() == 1 && Rest((*pieces)[0]).size() == 1);
    return Rest(pieces->at(0)).at(0);
  }
  double Value(TermId t) { return expr::Numeric(arena_, {{t_, 3}})(t); }

  Arena arena_;
  const Vector point_{Variable("x"), Variable("y"), Variable("z")};
  const TermId t_ = Variable("t");
  const TermId flat_ = arena_.Add(Square(arena_, point_[0]), Square(arena_, arena_.Sub(point_[1], t_)));
};

TEST_F(Sets, LinearConditionsAreHalfSpaces) {
  const Set s = Only(arena_.Le(arena_.Add(arena_.Mul(Number("2"), point_[0]), t_), point_[2]));
  ASSERT_EQ(s.kind, SetKind::kBelow);
  EXPECT_FALSE(s.open);
  // 2 x - z <= -t, up to a factor.
  const double factor = Value(s.normal[0]) / 2;
  EXPECT_GT(factor, 0);
  EXPECT_NEAR(Value(s.normal[1]), 0, 1e-12);
  EXPECT_NEAR(Value(s.normal[2]), -factor, 1e-12);
  EXPECT_NEAR(Value(s.bound), -3 * factor, 1e-12);
}

TEST_F(Sets, StrictConditionsAreOpen) {
  EXPECT_TRUE(Only(arena_.Lt(point_[0], t_)).open);
  EXPECT_TRUE(Only(arena_.Lt(flat_, t_)).open);
}

TEST_F(Sets, SquaresWithinABoundAreBalls) {
  const Set s = Only(arena_.Le(flat_, Number("4")));
  ASSERT_EQ(s.kind, SetKind::kBall);
  EXPECT_EQ(s.axes, (std::array<bool, 3>{true, true, false}));
  EXPECT_NEAR(Value(s.bound), 4, 1e-12);
  EXPECT_NEAR(Value(s.centre[0]), 0, 1e-12);
  EXPECT_NEAR(Value(s.centre[1]), 3, 1e-12);
}

TEST_F(Sets, SquaresBeyondABoundAreOutside) {
  const Set s = Only(arena_.Le(Number("4"), flat_));
  EXPECT_EQ(s.kind, SetKind::kOutside);
  EXPECT_NEAR(Value(s.bound), 4, 1e-12);
  EXPECT_NEAR(Value(s.centre[1]), 3, 1e-12);
}

TEST_F(Sets, AlternativesAreDifferentPieces) {
  const TermId left = arena_.Lt(point_[0], t_), high = arena_.Lt(t_, point_[2]);
  const auto pieces = Pieces({Ball("1")}, arena_.Or(left, high));
  ASSERT_TRUE(pieces.has_value());
  EXPECT_EQ(pieces->size(), 2u);
  EXPECT_EQ(Pieces({Ball("1")}, arena_.And(left, high))->size(), 1u);
}

TEST_F(Sets, UnionsGiveAPieceForEachCombination) {
  Shape both;
  both.parts = {Ball("1"), Ball("2")};
  EXPECT_EQ(Pieces({both, both}, arena_.True())->size(), 4u);
  EXPECT_FALSE(Pieces({both, both}, arena_.True(), 3).has_value());
}

TEST_F(Sets, OtherConditionsAreLeftOut) {
  const TermId wave = arena_.Apply(expr::Elementary::kSin, {point_[0]});
  const auto pieces = Pieces({Ball("1")}, arena_.Le(wave, t_));
  ASSERT_EQ(pieces->size(), 1u);
  EXPECT_TRUE(Rest(pieces->at(0)).empty());
}

TEST_F(Sets, FalseHasNoPieces) { EXPECT_TRUE(Pieces({Ball("1")}, arena_.False())->empty()); }

TEST_F(Sets, WhatLiesBeyondAShapeIsOutsideOfIt) {
  const auto pieces = PiecesOf(arena_, point_, {arena_.True(), {Ball("1")}, arena_.True(), Ball("3")}, 100);
  ASSERT_TRUE(pieces.has_value());
  EXPECT_TRUE(std::ranges::any_of(*pieces, [&](const Piece& p) {
    return std::ranges::any_of(p, [&](const Set& s) {
      return s.kind == SetKind::kOutside && s.open && std::abs(Value(s.bound) - 9) < 1e-12;
    });
  }));
}

TEST_F(Sets, CornersAreWhereNeighbouringFacesMeet) {
  Shape prism;
  prism.kind = ShapeKind::kPrism;
  const TermId zero = Number("0"), one = Number("1");
  const auto face = [&](const char* x, const char* y, const char* offset) {
    return Face{{Number(x), Number(y), zero}, Number(offset), one};
  };
  prism.faces = {face("1", "0", "4"), face("0", "1", "2"), face("-1", "0", "0"), face("0", "-1", "1")};
  const auto corners = Corners(arena_, prism);
  ASSERT_TRUE(corners.has_value());
  std::set<std::pair<double, double>> points;
  for (const auto& c : *corners) points.emplace(Value(c[0]), Value(c[1]));
  EXPECT_EQ(points, (std::set<std::pair<double, double>>{{4, 2}, {0, 2}, {0, -1}, {4, -1}}));
}

TEST_F(Sets, FacesThatDoNotGoAroundHaveNoCorners) {
  Shape prism;
  prism.kind = ShapeKind::kPrism;
  const TermId zero = Number("0"), one = Number("1");
  prism.faces = {{{one, zero, zero}, one, one}, {{zero, one, zero}, one, one}};
  EXPECT_FALSE(Corners(arena_, prism).has_value());
  prism.faces.push_back({{arena_.Neg(one), one, zero}, one, one});
  EXPECT_FALSE(Corners(arena_, prism).has_value());
  prism.faces = {{{one, zero, zero}, one, one},
                 {{zero, arena_.Neg(one), zero}, one, one},
                 {{arena_.Neg(one), one, zero}, one, one}};
  EXPECT_FALSE(Corners(arena_, prism).has_value());
}

}  // namespace
}  // namespace rondo::robot
