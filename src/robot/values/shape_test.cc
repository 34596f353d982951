#include "robot/values/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>

#include "expr/evaluate.h"

namespace rondo::robot {
namespace {

using expr::Rational;

class Shapes : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Number(double d) { return arena_.Number(arena_.Real(), Rational::FromDouble(d)); }
  Shape Make(ShapeKind kind, const std::vector<const char*>& sizes) {
    Shape s;
    s.kind = kind;
    s.frame = Translation(arena_, {Number("1"), Number("2"), Number("3")});
    for (const char* size : sizes) s.sizes.push_back(Number(size));
    return s;
  }
  Face FaceOf(const char* x, const char* y, const char* z, const char* offset, const char* length) {
    return {{Number(x), Number(y), Number(z)}, Number(offset), Number(length)};
  }
  // Around (1, 2, 3).
  bool Has(const Shape& shape, double x, double y, double z) {
    const TermId inside = Contains(arena_, shape, {Number(1 + x), Number(2 + y), Number(3 + z)});
    return expr::Evaluate(arena_, inside, [](TermId) { return std::nullopt; }).value().AsBool();
  }
  Shape Roof() {
    Shape prism = Make(ShapeKind::kPrism, {"0", "2"});
    prism.faces = {FaceOf("3", "4", "0", "5", "5"), FaceOf("-1", "0", "0", "1", "1"),
                   FaceOf("0", "-1", "0", "0", "1")};
    return prism;
  }
  Shape Half() {
    Shape s = Make(ShapeKind::kHalfSphere, {"1"});
    s.faces = {FaceOf("0", "0", "-1", "0", "1")};
    return s;
  }
  std::vector<Shape> All() {
    std::vector<Shape> all{Make(ShapeKind::kSphere, {"1"}),
                           Make(ShapeKind::kCylinder, {"1", "-1", "0.5"}),
                           Make(ShapeKind::kCapsule, {"0.5", "-1", "0.5"}),
                           Make(ShapeKind::kBox, {"-0.5", "1", "-1", "0", "0", "1"}),
                           Roof(),
                           Half()};
    Shape half_space = Make(ShapeKind::kHalfSpace, {});
    half_space.faces = {FaceOf("0", "3", "4", "1", "5")};
    all.push_back(half_space);
    for (const ShapeKind kind : {ShapeKind::kUnion, ShapeKind::kIntersection}) {
      Shape both;
      both.kind = kind;
      both.parts = {all[0], all[3]};
      all.push_back(both);
    }
    return all;
  }

  Arena arena_;
};

TEST_F(Shapes, SpheresAreClosed) {
  const Shape s = Make(ShapeKind::kSphere, {"2.5"});
  EXPECT_TRUE(Has(s, 1.5, 2, 0));
  EXPECT_FALSE(Has(s, 1.5, 2, 0.001));
  EXPECT_FALSE(Has(Make(ShapeKind::kSphere, {"-1"}), 0, 0, 0));
}

TEST_F(Shapes, CylindersHaveFlatEnds) {
  const Shape s = Make(ShapeKind::kCylinder, {"2.5", "-1", "4"});
  EXPECT_TRUE(Has(s, 1.5, 2, 4));
  EXPECT_TRUE(Has(s, 0, -2.5, -1));
  EXPECT_FALSE(Has(s, 0, 0, 4.001));
  EXPECT_FALSE(Has(s, 1.501, 2, 0));
}

TEST_F(Shapes, CapsulesHaveRoundEnds) {
  const Shape s = Make(ShapeKind::kCapsule, {"2.5", "-1", "4"});
  EXPECT_TRUE(Has(s, 0, 0, 6.5));
  EXPECT_TRUE(Has(s, 1.5, 0, 6));
  EXPECT_TRUE(Has(s, 0, 2.5, 1));
  EXPECT_FALSE(Has(s, 2, 0, 6));
  EXPECT_FALSE(Has(s, 0, 0, -3.501));
}

TEST_F(Shapes, BoxesAreBoundedAlongEachAxis) {
  const Shape s = Make(ShapeKind::kBox, {"-1", "2", "-3", "4", "-5", "6"});
  EXPECT_TRUE(Has(s, -1, 4, -5));
  using Point = std::array<double, 3>;
  for (const auto& [x, y, z] : {Point{-1.1, 0, 0}, Point{2.1, 0, 0}, Point{0, -3.1, 0}, Point{0, 4.1, 0},
                                Point{0, 0, -5.1}, Point{0, 0, 6.1}})
    EXPECT_FALSE(Has(s, x, y, z));
}

TEST_F(Shapes, PrismsAreBelowTheirFacesAndBetweenTheirEnds) {
  EXPECT_TRUE(Has(Roof(), -1, 2, 2));
  EXPECT_FALSE(Has(Roof(), -1, 2.001, 2));
  EXPECT_FALSE(Has(Roof(), -1.001, 0, 1));
  EXPECT_FALSE(Has(Roof(), 0, 0, 2.001));
}

TEST_F(Shapes, HalfSpheresAreAboveTheirFaces) {
  EXPECT_TRUE(Has(Half(), 0, 0, 1));
  EXPECT_TRUE(Has(Half(), 1, 0, 0));
  EXPECT_FALSE(Has(Half(), 0, 0, -0.001));
  EXPECT_FALSE(Has(Half(), 0.8, 0, 0.8));
}

TEST_F(Shapes, PartsAreJoinedOrMet) {
  const std::vector<Shape> all = All();
  EXPECT_TRUE(Has(all[7], -1, 0, 0) && Has(all[7], 1, -1, 1));
  EXPECT_FALSE(Has(all[8], -1, 0, 0) || Has(all[8], 1, -1, 1));
  EXPECT_TRUE(Has(all[8], 0.5, -0.5, 0));
}

TEST_F(Shapes, NothingIsInAnEmptyUnion) {
  EXPECT_EQ(Contains(arena_, Shape{}, {Number("0"), Number("0"), Number("0")}), arena_.False());
}

TEST_F(Shapes, FramesTurnWhatIsInThem) {
  Shape s = Make(ShapeKind::kBox, {"0", "4", "-1", "1", "-1", "1"});
  const TermId quarter = arena_.Mul(Number("0.5"), Pi(arena_));
  s.frame = Compose(arena_, s.frame, Rotation(arena_, 2, quarter));
  EXPECT_TRUE(Has(s, 0, 4, 0));
  EXPECT_FALSE(Has(s, 0, -1, 0));
  EXPECT_FALSE(Has(s, 4, 0, 0));
}

TEST_F(Shapes, InflatedShapesHoldWhatIsNear) {
  // Points of a grid in the shape, moved by exactly the margin.
  const std::array<Eigen::Vector3d, 6> ways{Eigen::Vector3d{0.25, 0, 0},
                                            {0, -0.25, 0},
                                            {0, 0, 0.25},
                                            {0.15, 0.2, 0},
                                            {-0.2, 0, 0.15},
                                            {0, 0.15, -0.2}};
  for (const Shape& shape : All()) {
    const Shape wide = Inflate(arena_, shape, Number("0.2500000001"));
    int inside = 0;
    for (double x = -1; x <= 1; x += 0.5) {
      for (double y = -1; y <= 1; y += 0.5) {
        for (double z = -1; z <= 1; z += 0.5) {
          if (!Has(shape, x, y, z)) continue;
          ++inside;
          for (const auto& w : ways)
            EXPECT_TRUE(Has(wide, x + w.x(), y + w.y(), z + w.z())) << static_cast<int>(shape.kind);
        }
      }
    }
    EXPECT_GT(inside, 0);
  }
}

TEST_F(Shapes, InflatedShapesAreNotWiderThanNeeded) {
  const TermId margin = Number("0.25");
  EXPECT_FALSE(Has(Inflate(arena_, Make(ShapeKind::kSphere, {"1"}), margin), 0, 0, 1.251));
  EXPECT_FALSE(Has(Inflate(arena_, Make(ShapeKind::kCapsule, {"0.5", "-1", "0.5"}), margin), 0, 0, 1.251));
  EXPECT_FALSE(Has(Inflate(arena_, Roof(), margin), 1, 0.5 + 0.3126, 1));
}

}  // namespace
}  // namespace rondo::robot
