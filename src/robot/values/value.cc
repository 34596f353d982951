#include "robot/values/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>

#include "expr/substitute.h"

namespace rondo::robot {

Value Quantity(TermId term, lang::Dimension dimension) {
  Value v;
  v.kind = ValueKind::kQuantity;
  v.dimension = dimension;
  v.terms = {term};
  return v;
}

Value Boolean(TermId term) {
  Value v;
  v.kind = ValueKind::kBool;
  v.terms = {term};
  return v;
}

Value PointAt(const Vector& p) {
  Value v;
  v.kind = ValueKind::kPoint;
  v.dimension = kLength;
  v.terms = {p.begin(), p.end()};
  return v;
}

Value FrameAt(const Pose& pose) {
  Value v;
  v.kind = ValueKind::kFrame;
  v.pose = std::make_shared<const Pose>(pose);
  return v;
}

Value ShapeOf(Shape shape) {
  Value v;
  v.kind = ValueKind::kShape;
  v.shape = std::make_shared<const Shape>(std::move(shape));
  return v;
}

std::set<TermId> VariablesOf(const Arena& arena, const std::vector<TermId>& terms) {
  std::set<TermId> variables;
  std::unordered_set<TermId> seen;
  for (const TermId t : terms) {
    expr::VisitPostorder(arena, t, seen, [&](TermId part) {
      if (arena.op(part) == expr::Op::kVariable) variables.insert(part);
    });
  }
  return variables;
}

bool IsConstant(const Arena& arena, const Value& value) { return VariablesOf(arena, value.terms).empty(); }

bool IsConstant(const Arena& arena, const Pose& pose) {
  std::vector<TermId> terms(pose.origin.begin(), pose.origin.end());
  for (const Vector& row : pose.rotation) terms.insert(terms.end(), row.begin(), row.end());
  return VariablesOf(arena, terms).empty();
}

bool IsConstant(const Arena& arena, const Shape& shape) {
  std::vector<TermId> terms = shape.sizes;
  for (const Face& f : shape.faces) {
    terms.insert(terms.end(), f.normal.begin(), f.normal.end());
    terms.push_back(f.offset);
  }
  const bool own = shape.kind == ShapeKind::kUnion || shape.kind == ShapeKind::kIntersection ||
                   IsConstant(arena, shape.frame);
  return own && VariablesOf(arena, terms).empty() &&
         std::ranges::all_of(shape.parts, [&](const Shape& part) { return IsConstant(arena, part); });
}

std::string UnitText(lang::Dimension d) {
  struct Base {
    const char* unit;
    int exponent;
  };
  const std::array<Base, 3> bases{{{"m", d.length}, {"s", d.time}, {"rad", d.angle}}};
  std::string above, below;
  for (const Base& b : bases) {
    if (b.exponent == 0) continue;
    std::string& side = b.exponent > 0 ? above : below;
    const int times = b.exponent > 0 ? b.exponent : -b.exponent;
    if (!side.empty()) side += ' ';
    side += times == 1 ? b.unit : fmt::format("{}^{}", b.unit, times);
  }
  if (above.empty() && below.empty()) return "a number";
  return below.empty() ? above : fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

std::string Describe(const Value& value) {
  switch (value.kind) {
    case ValueKind::kError:
      return "an error";
    case ValueKind::kBool:
      return "true or false";
    case ValueKind::kQuantity:
      if (value.dimension == lang::Dimension{}) return "a number";
      if (value.dimension == kLength) return "a length";
      if (value.dimension == kTime) return "a time";
      if (value.dimension == kAngle) return "an angle";
      return fmt::format("a quantity in {}", UnitText(value.dimension));
    case ValueKind::kCoordinates:
      return fmt::format("a {} of coordinates{}", value.terms.size() == 2 ? "pair" : "triple",
                         value.dimension == lang::Dimension{} ? "" : " in " + UnitText(value.dimension));
    case ValueKind::kPoint:
      return "a point of the world";
    case ValueKind::kFrame:
      return "a frame";
    case ValueKind::kShape:
      return "a shape";
    case ValueKind::kComponent:
      return "a robot";
  }
  return {};
}

}  // namespace rondo::robot
