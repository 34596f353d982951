#include "robot/separation/cuts.h"

#include <gtest/gtest.h>

#include "expr/evaluate.h"

namespace rondo::robot {
namespace {

using expr::Rational;

/// A ball at the origin and one that moves along the first axis, of radius one.
class Cutting : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  Set Solid(ShapeKind kind, const std::vector<const char*>& sizes, TermId x) {
    Set set;
    set.solid.kind = kind;
    set.solid.frame = Translation(arena_, {x, zero_, zero_});
    for (const char* s : sizes) set.solid.sizes.push_back(Number(s));
    return set;
  }
  Set Below(TermId bound, bool open) {
    Set set;
    set.kind = SetKind::kBelow;
    set.normal = {Number("1"), zero_, zero_};
    set.bound = bound;
    set.open = open;
    return set;
  }
  bool Holds(TermId condition, double t) {
    return expr::Numeric(arena_, {{t_, t}}).Violation(condition) == 0;
  }
  // Conditions fail where they were looked for, and hold wherever the sets meet.
  void ExpectSound(const Cut& cut, double at, const std::vector<double>& meetings) {
    EXPECT_FALSE(cut.conditions.empty());
    for (const TermId c : cut.conditions) {
      EXPECT_FALSE(Holds(c, at));
      for (const double t : meetings) EXPECT_TRUE(Holds(c, t)) << t;
    }
  }

  Arena arena_;
  const TermId zero_ = arena_.Number(arena_.Real(), Rational(0));
  const TermId t_ = arena_.Variable(arena_.Declare("t", {}, arena_.Real()));
  const Piece balls_{Solid(ShapeKind::kSphere, {"1"}, zero_), Solid(ShapeKind::kSphere, {"1"}, t_)};
};

TEST_F(Cutting, SeparatedSetsAreCutApart) {
  Cut cut = Cuts(arena_, balls_).At({{t_, 5}});
  ExpectSound(cut, 5, {-1.99, -1, 0, 1, 1.99});
  EXPECT_NEAR(cut.apart, 3, 0.01);
}

TEST_F(Cutting, SetsThatOverlapAreNotCut) {
  const Cut cut = Cuts(arena_, balls_).At({{t_, 1}});
  EXPECT_TRUE(cut.conditions.empty());
  EXPECT_LT(cut.apart, 0);
}

TEST_F(Cutting, HalfSpacesCutSolids) {
  const Piece piece{Solid(ShapeKind::kBox, {"-1", "1", "-1", "1", "-1", "1"}, t_), Below(Number("2"), false)};
  ExpectSound(Cuts(arena_, piece).At({{t_, 4}}), 4, {-10, 0, 2.9});
}

TEST_F(Cutting, TouchingCountsUnlessTheBoundaryIsMissing) {
  const std::vector<const char*> sizes{"-1", "1", "-1", "1", "-1", "1"};
  for (const bool open : {false, true}) {
    const Cut cut = Cuts(arena_, {Solid(ShapeKind::kBox, sizes, t_), Below(Number("2"), open)}).At({{t_, 4}});
    ASSERT_FALSE(cut.conditions.empty());
    const auto holds =
        expr::Evaluate(arena_, cut.conditions[0], [](TermId) { return expr::Value{Rational(3)}; });
    EXPECT_EQ(holds.value().AsBool(), !open);
  }
}

TEST_F(Cutting, SolidsWithinTheHoleOfAnOutsideNeedNoConfiguration) {
  Set outside;
  outside.kind = SetKind::kOutside;
  outside.centre = {zero_, zero_, zero_};
  outside.bound = Number("9");
  const std::vector<TermId> common = Cuts(arena_, {balls_[1], outside}).Common();
  ASSERT_EQ(common.size(), 1u);
  EXPECT_FALSE(Holds(common[0], 1.9));
  EXPECT_TRUE(Holds(common[0], 2.1));
  EXPECT_TRUE(Cuts(arena_, balls_).Common().empty());
}

}  // namespace
}  // namespace rondo::robot
