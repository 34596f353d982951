#include "robot/values/functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "lang/suggest.h"

namespace rondo::robot {

using diag::Kind;
using expr::Elementary;
using expr::Rational;
using lang::Dimension;

const Functions::Entry Functions::kTable[] = {
    {"sqrt", 1, 1, &Functions::Sqrt},
    {"abs", 1, 1, &Functions::Abs},
    {"min", 2, 2, &Functions::Extreme},
    {"max", 2, 2, &Functions::Extreme},
    {"clamp", 3, 3, &Functions::Clamp},
    {"select", 3, 3, &Functions::Select},
    {"exp", 1, 1, &Functions::Exponential},
    {"log", 1, 1, &Functions::Exponential},
    {"sin", 1, 1, &Functions::Trigonometric},
    {"cos", 1, 1, &Functions::Trigonometric},
    {"tan", 1, 1, &Functions::Trigonometric},
    {"asin", 1, 1, &Functions::InverseTrigonometric},
    {"acos", 1, 1, &Functions::InverseTrigonometric},
    {"atan", 1, 1, &Functions::InverseTrigonometric},
    {"atan2", 2, 2, &Functions::Atan2},
    {"pow", 2, 2, &Functions::Power},
    {"near", 3, 3, &Functions::Near},
    {"between", 3, 4, &Functions::Between},
    {"linear", 4, 4, &Functions::Linear},
    {"smoothstep", 4, 4, &Functions::SmoothStep},
    {"dist", 2, 2, &Functions::Distance},
    {"norm", 1, 1, &Functions::Length},
    {"dot", 2, 2, &Functions::DotProduct},
    {"dir", 1, 1, &Functions::Direction},
    {"point", 3, 3, &Functions::Point},
    {"point_in", 2, 2, &Functions::PointIn},
    {"coordinates", 2, 2, &Functions::Coordinates},
    {"origin", 1, 1, &Functions::Origin},
    {"on_segment", 4, 4, &Functions::OnSegment},
    {"translate", 3, 3, &Functions::Translate},
    {"rotate_x", 1, 1, &Functions::Rotate},
    {"rotate_y", 1, 1, &Functions::Rotate},
    {"rotate_z", 1, 1, &Functions::Rotate},
    {"sphere", 2, 2, &Functions::Ball},
    {"cylinder", 3, 4, &Functions::Cylinder},
    {"capsule", 3, 4, &Functions::Cylinder},
    {"box", 3, 3, &Functions::Box},
    {"prism", 6, 99, &Functions::Prism},
    {"hexagon", 4, 4, &Functions::Hexagon},
    {"half_space", 3, 3, &Functions::HalfSpace},
    {"half_sphere", 2, 2, &Functions::HalfSphere},
    {"union", 0, 99, &Functions::Combined},
    {"intersection", 1, 99, &Functions::Combined},
    {"inflate", 2, 2, &Functions::Inflated},
};

Value Functions::Call(const lang::Expr& call, const Scope& scope) {
  const lang::Expr& callee = e_.pool_[call.args[0]];
  const auto* entry = std::ranges::find(kTable, callee.text, &Entry::name);
  if (callee.kind != lang::ExprKind::kName || entry == std::end(kTable)) {
    std::vector<std::string> names;
    for (const Entry& known : kTable) names.emplace_back(known.name);
    auto& report = e_.diagnostics_.Report(Kind::kChoreoUndeclared, callee.span,
                                          fmt::format("there is no function `{}`", callee.text));
    if (const std::string near = lang::Suggest(callee.text, names); !near.empty())
      report.Help(fmt::format("did you mean `{}`?", near)).Fix(callee.span, near);
    return {};
  }
  const size_t count = call.args.size() - 1;
  if (count < entry->least || count > entry->most) {
    e_.diagnostics_.Report(
        Kind::kChoreoArity, call.span,
        fmt::format("`{}` takes {}{} argument{}", entry->name, entry->least,
                    entry->most > entry->least ? " or more" : "", entry->most == 1 ? "" : "s"));
    return {};
  }
  Arguments args{call, {}};
  bool good = true;
  for (size_t i = 0; i < count; ++i) {
    args.values.push_back(e_.Evaluate(call.args[i + 1], scope));
    good = good && args.values.back().kind != ValueKind::kError;
  }
  return good ? (this->*entry->handler)(args) : Value{};
}

// -- arguments

bool Functions::NeedQuantity(const Arguments& a, size_t i) {
  if (a.values[i].kind == ValueKind::kQuantity) return true;
  e_.WrongType(SpanOf(a, i), a.values[i], "a quantity");
  return false;
}

bool Functions::Need(const Arguments& a, size_t i, Dimension dimension, std::string_view what) {
  if (!NeedQuantity(a, i)) return false;
  if (a.values[i].any_dimension || a.values[i].dimension == dimension) return true;
  e_.WrongUnit(SpanOf(a, i), a.values[i], what);
  return false;
}

bool Functions::NeedVector(const Arguments& a, size_t i) {
  const ValueKind kind = a.values[i].kind;
  if (kind == ValueKind::kCoordinates || kind == ValueKind::kPoint) return true;
  e_.WrongType(SpanOf(a, i), a.values[i], "a point or coordinates");
  return false;
}

bool Functions::NeedFrame(const Arguments& a, size_t i) {
  if (a.values[i].kind == ValueKind::kFrame) return true;
  e_.WrongType(SpanOf(a, i), a.values[i], "a frame");
  return false;
}

bool Functions::NeedShape(const Arguments& a, size_t i) {
  if (a.values[i].kind == ValueKind::kShape) return true;
  e_.WrongType(SpanOf(a, i), a.values[i], "a shape");
  return false;
}

bool Functions::NeedSame(Arguments& a, size_t i, size_t j) {
  Value& first = a.values[i];
  Value& second = a.values[j];
  if (first.kind != second.kind || first.terms.size() != second.terms.size()) {
    e_.WrongType(SpanOf(a, j), second, fmt::format("something like {}", Describe(first)));
    return false;
  }
  if (Evaluator::Agree(first, second)) return true;
  e_.WrongUnit(SpanOf(a, j), second, fmt::format("something in {}", UnitText(first.dimension)));
  return false;
}

std::optional<Vector> Functions::NeedLengths(const Arguments& a, size_t i) {
  const Value& v = a.values[i];
  if (v.kind != ValueKind::kCoordinates || v.terms.size() != 3) {
    e_.WrongType(SpanOf(a, i), v, "three coordinates");
    return std::nullopt;
  }
  if (!v.any_dimension && !(v.dimension == kLength)) {
    e_.WrongUnit(SpanOf(a, i), v, "coordinates in m");
    return std::nullopt;
  }
  return XYZ(v);
}

Vector Functions::XYZ(const Value& v) { return {v.terms[0], v.terms[1], v.terms[2]}; }

// -- numbers

Value Functions::Sqrt(Arguments& a) {
  if (!NeedQuantity(a, 0)) return {};
  const Dimension d = a.values[0].dimension;
  if (d.length % 2 != 0 || d.time % 2 != 0 || d.angle % 2 != 0)
    return e_.WrongUnit(SpanOf(a, 0), a.values[0], "the square of something");
  Value root = Quantity(arena_.Apply(Elementary::kSqrt, {a.values[0].terms[0]}),
                        {d.length / 2, d.time / 2, d.angle / 2});
  root.any_dimension = a.values[0].any_dimension;
  return root;
}

Value Functions::Abs(Arguments& a) {
  if (!NeedQuantity(a, 0)) return {};
  Value v = a.values[0];
  v.terms[0] = arena_.Apply(Elementary::kAbs, {v.terms[0]});
  v.squared.reset();
  return v;
}

Value Functions::Extreme(Arguments& a) {
  if (!NeedQuantity(a, 0) || !NeedSame(a, 0, 1)) return {};
  const bool min = e_.pool_[a.call.args[0]].text == "min";
  Value v = a.values[0];
  v.terms[0] = arena_.Apply(min ? Elementary::kMin : Elementary::kMax, {v.terms[0], a.values[1].terms[0]});
  v.squared.reset();
  return v;
}

Value Functions::Clamp(Arguments& a) {
  if (!NeedQuantity(a, 0) || !NeedSame(a, 0, 1) || !NeedSame(a, 0, 2)) return {};
  Value v = a.values[0];
  v.terms[0] = arena_.Apply(
      Elementary::kMin,
      {arena_.Apply(Elementary::kMax, {v.terms[0], a.values[1].terms[0]}), a.values[2].terms[0]});
  v.squared.reset();
  return v;
}

// select(condition, then, otherwise)
Value Functions::Select(Arguments& a) {
  if (a.values[0].kind != ValueKind::kBool) return e_.WrongType(SpanOf(a, 0), a.values[0], "a formula");
  if (!NeedQuantity(a, 1) || !NeedSame(a, 1, 2)) return {};
  Value v = a.values[1];
  v.terms[0] = arena_.Ite(a.values[0].terms[0], v.terms[0], a.values[2].terms[0]);
  v.squared.reset();
  return v;
}

Value Functions::Exponential(Arguments& a) {
  if (!Need(a, 0, {}, "a number")) return {};
  const bool exp = e_.pool_[a.call.args[0]].text == "exp";
  return Quantity(arena_.Apply(exp ? Elementary::kExp : Elementary::kLog, {a.values[0].terms[0]}), {});
}

Value Functions::Trigonometric(Arguments& a) {
  if (!Need(a, 0, kAngle, "an angle")) return {};
  const TermId angle = a.values[0].terms[0];
  const std::string& name = e_.pool_[a.call.args[0]].text;
  if (name == "sin") return Quantity(Sin(arena_, angle), {});
  if (name == "cos") return Quantity(Cos(arena_, angle), {});
  return Quantity(arena_.Apply(Elementary::kTan, {angle}), {});
}

Value Functions::InverseTrigonometric(Arguments& a) {
  if (!Need(a, 0, {}, "a number")) return {};
  const std::string& name = e_.pool_[a.call.args[0]].text;
  const Elementary f = name == "asin"   ? Elementary::kAsin
                       : name == "acos" ? Elementary::kAcos
                                        : Elementary::kAtan;
  return Quantity(arena_.Apply(f, {a.values[0].terms[0]}), kAngle);
}

Value Functions::Atan2(Arguments& a) {
  if (!NeedQuantity(a, 0) || !NeedSame(a, 0, 1)) return {};
  return Quantity(arena_.Apply(Elementary::kAtan2, {a.values[0].terms[0], a.values[1].terms[0]}), kAngle);
}

Value Functions::Power(Arguments& a) {
  constexpr int kMostPower = 16;
  if (!NeedQuantity(a, 0) || !Need(a, 1, {}, "a number")) return {};
  const TermId power = a.values[1].terms[0];
  if (!arena_.IsNumber(power) || !arena_.number(power).IsInteger() || arena_.number(power) < Rational(0) ||
      arena_.number(power) > Rational(kMostPower)) {
    e_.diagnostics_.Report(Kind::kRobotType, SpanOf(a, 1),
                           fmt::format("an exponent is a whole number from 0 to {}", kMostPower));
    return {};
  }
  const int n = static_cast<int>(arena_.number(power).ToDouble());
  TermId product = Number(Rational(1));
  for (int i = 0; i < n; ++i) product = arena_.Mul(product, a.values[0].terms[0]);
  const Dimension d = a.values[0].dimension;
  Value v = Quantity(product, {d.length * n, d.time * n, d.angle * n});
  v.any_dimension = n > 0 && a.values[0].any_dimension;
  return v;
}

// |v - w| <= tolerance; of coordinates, their distance.
Value Functions::Near(Arguments& a) {
  if (!NeedSame(a, 0, 1)) return {};
  const Value& v = a.values[0];
  if (v.kind != ValueKind::kQuantity && !NeedVector(a, 0)) return {};
  if (!NeedQuantity(a, 2)) return {};
  if (!v.any_dimension && !Need(a, 2, v.dimension, fmt::format("a tolerance in {}", UnitText(v.dimension))))
    return {};
  const TermId tolerance = a.values[2].terms[0];
  std::vector<TermId> difference;
  for (size_t i = 0; i < v.terms.size(); ++i)
    difference.push_back(arena_.Sub(v.terms[i], a.values[1].terms[i]));
  if (v.kind == ValueKind::kQuantity)
    return Boolean(
        arena_.And(arena_.Le(arena_.Neg(tolerance), difference[0]), arena_.Le(difference[0], tolerance)));
  std::vector<TermId> squares;
  for (const TermId d : difference) squares.push_back(Square(arena_, d));
  return Boolean(arena_.And(arena_.Le(Number(Rational(0)), tolerance),
                            arena_.Le(arena_.Add(squares), Square(arena_, tolerance))));
}

// v is between a and b, in whichever order, or no farther than a tolerance from there.
Value Functions::Between(Arguments& a) {
  if (!NeedQuantity(a, 0) || !NeedSame(a, 0, 1) || !NeedSame(a, 0, 2)) return {};
  if (a.values.size() == 4 && !NeedSame(a, 0, 3)) return {};
  const TermId v = a.values[0].terms[0];
  const TermId slack = a.values.size() == 4 ? a.values[3].terms[0] : Number(Rational(0));
  TermId low = a.values[1].terms[0], high = a.values[2].terms[0];
  if (Below(high, low)) {
    std::swap(low, high);
  } else if (!Below(low, high)) {
    const TermId other = low;
    low = arena_.Apply(Elementary::kMin, {other, high});
    high = arena_.Apply(Elementary::kMax, {other, high});
  }
  return Boolean(arena_.And(arena_.Le(arena_.Sub(low, slack), v), arena_.Le(v, arena_.Add(high, slack))));
}

// Is a < b for certain, or is that not known?
bool Functions::Below(TermId a, TermId b) {
  return arena_.Lt(a, b) == arena_.True() || IsBelow(arena_, a, b);
}

// -- points

// -- frames

}  // namespace rondo::robot
