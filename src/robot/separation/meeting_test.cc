#include "robot/separation/meeting.h"

#include <gtest/gtest.h>

#include "expr/evaluate.h"

namespace rondo::robot {
namespace {

using expr::Rational;

class Meetings : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Shape Make(ShapeKind kind, const std::vector<const char*>& sizes) {
    Shape s;
    s.kind = kind;
    s.frame = Identity(arena_);
    for (const char* size : sizes) s.sizes.push_back(Number(size));
    return s;
  }
  Shape Moved(Shape s) {
    const TermId zero = Number("0");
    s.frame = Translation(arena_, {t_, zero, zero});
    return s;
  }
  Shape Joined(ShapeKind kind, std::vector<Shape> parts) {
    Shape s;
    s.kind = kind;
    s.parts = std::move(parts);
    return s;
  }
  bool Holds(TermId formula, double x, double y, double z, double t = 0) {
    const std::map<TermId, double> values{{point_[0], x}, {point_[1], y}, {point_[2], z}, {t_, t}};
    return expr::Evaluate(arena_, formula,
                          [&](TermId v) { return expr::Value{Rational::FromDouble(values.at(v))}; })
        .value()
        .AsBool();
  }
  bool Surely(TermId formula) { return formula == arena_.True(); }

  Arena arena_;
  const Vector point_{Variable("x"), Variable("y"), Variable("z")};
  const TermId t_ = Variable("t");
  const Shape ball_ = Make(ShapeKind::kSphere, {"1"});
  const Shape box_ = Make(ShapeKind::kBox, {"-1", "1", "-1", "1", "-1", "1"});
};

TEST_F(Meetings, PointsOfAMeetingAreInAllShapes) {
  Meeting m{
      arena_.Le(t_, Number("5")), {ball_, Moved(box_)}, arena_.Lt(Number("0"), point_[2]), std::nullopt};
  const TermId f = Formula(arena_, point_, m);
  EXPECT_TRUE(Holds(f, 0.5, 0, 0.5, 1));
  EXPECT_FALSE(Holds(f, 0.5, 0, 0, 1));     // not where
  EXPECT_FALSE(Holds(f, -0.5, 0, 0.5, 1));  // not in the box
  EXPECT_FALSE(Holds(f, 0.9, 0, 0.9, 1));   // not in the ball
  EXPECT_FALSE(Holds(f, 0.5, 0, 0.5, 6));   // not in such a state
}

TEST_F(Meetings, PointsBeyondAreOutside) {
  Meeting m{arena_.True(), {box_}, arena_.True(), ball_};
  const TermId f = Formula(arena_, point_, m);
  EXPECT_TRUE(Holds(f, 0.75, 0.75, 0.75));
  EXPECT_FALSE(Holds(f, 1, 0, 0));
}

TEST_F(Meetings, LocalPointsAreTheSameElsewhere) {
  Meeting m{arena_.True(), {Moved(box_), ball_}, arena_.Lt(Number("0"), point_[0]), std::nullopt};
  const TermId whole = Formula(arena_, point_, m);
  const auto local = LocalFormulas(arena_, point_, m);
  ASSERT_EQ(local.size(), 1u);
  for (double x = -2; x <= 2; x += 0.25) {
    for (const double t : {-1.5, 0.0, 0.5, 1.75})
      EXPECT_EQ(Holds(whole, x + t, 0.5, 0, t), Holds(local[0], x, 0.5, 0, t)) << x << " " << t;
  }
}

TEST_F(Meetings, EachPartOfAUnionIsAsked) {
  Meeting m{
      arena_.True(), {Joined(ShapeKind::kUnion, {Moved(box_), ball_}), ball_}, arena_.True(), std::nullopt};
  EXPECT_EQ(LocalFormulas(arena_, point_, m).size(), 2u);
}

TEST_F(Meetings, SmallerShapesLieWithin) {
  EXPECT_TRUE(Surely(Within(arena_, ball_, Make(ShapeKind::kSphere, {"1"}))));
  EXPECT_FALSE(Surely(Within(arena_, ball_, Make(ShapeKind::kSphere, {"0.9"}))));
  EXPECT_TRUE(Surely(Within(arena_, Make(ShapeKind::kBox, {"-1", "0", "0", "1", "-1", "1"}), box_)));
  EXPECT_FALSE(Surely(Within(arena_, Make(ShapeKind::kBox, {"-1", "0", "0", "1.5", "-1", "1"}), box_)));
  EXPECT_FALSE(Surely(Within(arena_, Make(ShapeKind::kBox, {"-1", "0", "0", "1", "-1", "1.1"}), box_)));
  const Shape tall = Make(ShapeKind::kCylinder, {"1", "-2", "3"});
  EXPECT_TRUE(Surely(Within(arena_, Make(ShapeKind::kCylinder, {"1", "-1", "3"}), tall)));
  EXPECT_FALSE(Surely(Within(arena_, Make(ShapeKind::kCylinder, {"1", "-3", "3"}), tall)));
  EXPECT_FALSE(Surely(Within(arena_, Make(ShapeKind::kCylinder, {"2", "-1", "3"}), tall)));
}

TEST_F(Meetings, BoxesLieWithinCylinders) {
  EXPECT_TRUE(Surely(Within(arena_, box_, Make(ShapeKind::kCylinder, {"1.5", "-1", "1"}))));
  EXPECT_FALSE(Surely(Within(arena_, box_, Make(ShapeKind::kCylinder, {"1.4", "-1", "1"}))));
  EXPECT_FALSE(Surely(Within(arena_, box_, Make(ShapeKind::kCylinder, {"1.5", "-1", "0.5"}))));
  EXPECT_FALSE(Surely(Within(arena_, box_, Make(ShapeKind::kCylinder, {"-1.5", "-1", "1"}))));
}

TEST_F(Meetings, NothingIsSaidOfOtherFramesAndKinds) {
  EXPECT_EQ(Within(arena_, Moved(ball_), ball_), arena_.False());
  EXPECT_EQ(Within(arena_, ball_, box_), arena_.False());
}

TEST_F(Meetings, EveryPartOfTheInnerAndSomeOfTheOuterMustFit) {
  const Shape small = Make(ShapeKind::kSphere, {"0.5"});
  EXPECT_TRUE(Surely(Within(arena_, Joined(ShapeKind::kUnion, {ball_, small}), ball_)));
  EXPECT_FALSE(Surely(Within(arena_, Joined(ShapeKind::kUnion, {ball_, small}), small)));
  EXPECT_TRUE(Surely(Within(arena_, ball_, Joined(ShapeKind::kUnion, {small, ball_}))));
  EXPECT_FALSE(Surely(Within(arena_, ball_, Joined(ShapeKind::kIntersection, {small, ball_}))));
  EXPECT_TRUE(Surely(Within(arena_, Joined(ShapeKind::kIntersection, {small, ball_}), small)));
}

TEST_F(Meetings, ShapesWithInvertedSizesMayBeEmpty) {
  const auto may = [&](const Shape& s) { return MayBeEmpty(arena_, s) == arena_.True(); };
  EXPECT_FALSE(may(ball_) || may(box_));
  EXPECT_TRUE(may(Make(ShapeKind::kSphere, {"-1"})));
  EXPECT_TRUE(may(Make(ShapeKind::kBox, {"-1", "1", "1", "-1", "-1", "1"})));
  EXPECT_TRUE(may(Make(ShapeKind::kBox, {"-1", "1", "-1", "1", "1", "-1"})));
  EXPECT_TRUE(may(Make(ShapeKind::kCylinder, {"1", "2", "1"})));
  EXPECT_TRUE(may(Joined(ShapeKind::kUnion, {ball_, Make(ShapeKind::kCapsule, {"-1", "0", "1"})})));
}

TEST_F(Meetings, ShapesAreUndefinedWhereTheirSizesAre) {
  Shape s = ball_;
  s.sizes[0] = arena_.Apply(expr::Elementary::kSqrt, {t_});
  EXPECT_TRUE(Holds(Undefined(arena_, s), 0, 0, 0, -1));
  EXPECT_FALSE(Holds(Undefined(arena_, s), 0, 0, 0, 1));
  EXPECT_EQ(Undefined(arena_, box_), arena_.False());
}

}  // namespace
}  // namespace rondo::robot
