#include "robot/values/evaluate.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/defined.h"
#include "lang/suggest.h"
#include "robot/values/functions.h"

namespace rondo::robot {

using diag::Kind;
using diag::Span;
using expr::Rational;
using lang::Dimension;
using lang::Expr;
using lang::ExprKind;

namespace {

Dimension operator+(Dimension a, Dimension b) {
  return {a.length + b.length, a.time + b.time, a.angle + b.angle};
}
Dimension operator-(Dimension a, Dimension b) {
  return {a.length - b.length, a.time - b.time, a.angle - b.angle};
}

bool IsVector(const Value& v) { return v.kind == ValueKind::kCoordinates || v.kind == ValueKind::kPoint; }

}  // namespace

const Value* Scope::Find(std::string_view name) const {
  for (const Scope* scope = this; scope != nullptr; scope = scope->outer) {
    if (const auto it = scope->names.find(name); it != scope->names.end()) return &it->second;
  }
  return nullptr;
}

Value Evaluator::WrongUnit(Span span, const Value& got, std::string_view wanted) {
  auto& report = diagnostics_.Report(Kind::kRobotUnit, span,
                                     fmt::format("this is {}, but {} is needed", Describe(got), wanted));
  if (got.dimension == Dimension{}) report.Help("numbers carry a unit: `2 m`, `90 deg`, `1.5 s`");
  return {};
}

Value Evaluator::WrongType(Span span, const Value& got, std::string_view wanted) {
  if (got.kind != ValueKind::kError)
    diagnostics_.Report(Kind::kRobotType, span,
                        fmt::format("this is {}, but {} is needed", Describe(got), wanted));
  return {};
}

bool Evaluator::Agree(Value& a, Value& b) {
  if (a.any_dimension && !b.any_dimension) {
    a.dimension = b.dimension;
    a.any_dimension = false;
  } else if (b.any_dimension && !a.any_dimension) {
    b.dimension = a.dimension;
    b.any_dimension = false;
  }
  return a.dimension == b.dimension;
}

TermId Evaluator::Formula(ExprId expr, const Scope& scope, std::string_view what) {
  if (!expr.valid()) return arena_.True();
  const Value v = Evaluate(expr, scope);
  if (v.kind == ValueKind::kBool) return v.terms[0];
  WrongType(SpanOf(expr), v, what);
  return arena_.True();
}

std::optional<TermId> Evaluator::Measure(ExprId expr, const Scope& scope, Dimension dimension,
                                         std::string_view what) {
  const Value v = Evaluate(expr, scope);
  if (v.kind == ValueKind::kError) return std::nullopt;
  if (v.kind != ValueKind::kQuantity) {
    WrongType(SpanOf(expr), v, what);
  } else if (v.any_dimension || v.dimension == dimension) {
    return v.terms[0];
  } else {
    WrongUnit(SpanOf(expr), v, what);
  }
  return std::nullopt;
}

std::optional<Shape> Evaluator::ShapeAt(ExprId expr, const Scope& scope, std::string_view what) {
  const Value v = Evaluate(expr, scope);
  if (v.kind == ValueKind::kShape) return *v.shape;
  WrongType(SpanOf(expr), v, what);
  return std::nullopt;
}

std::optional<Pose> Evaluator::Place(ExprId expr, const Scope& scope, const Pose& base) {
  const Value v = Evaluate(expr, scope);
  if (v.kind == ValueKind::kFrame) return *v.pose;
  if (v.kind == ValueKind::kCoordinates && v.terms.size() == 3) {
    if (v.any_dimension || v.dimension == kLength)
      return Compose(arena_, base, Translation(arena_, {v.terms[0], v.terms[1], v.terms[2]}));
    WrongUnit(SpanOf(expr), v, "a place, three lengths,");
  } else {
    WrongType(SpanOf(expr), v, "a place: `(x, y, z)` or a frame,");
  }
  return std::nullopt;
}

Value Evaluator::Evaluate(ExprId expr, const Scope& scope) { return Visit(pool_[expr], scope); }

// Exact numbers may grow without bound.
Value Evaluator::Bounded(const Expr& e, Value v) {
  constexpr size_t kMostDigits = 2000;
  for (const TermId t : v.terms) {
    if (!arena_.IsNumber(t) || arena_.number(t).Digits() <= kMostDigits) continue;
    diagnostics_.Report(Kind::kSyntaxNumber, e.span, "this number has too many digits");
    return {};
  }
  return v;
}

Value Evaluator::Visit(const Expr& e, const Scope& scope) {
  switch (e.kind) {
    case ExprKind::kError:
      return {};
    case ExprKind::kInt:
    case ExprKind::kFloat:
      return Literal(e);
    case ExprKind::kQuantity:
      return WithUnit(e);
    case ExprKind::kBool:
      return Boolean(arena_.Constant(e.text == "true"));
    case ExprKind::kName:
      return Named(e, scope);
    case ExprKind::kField:
      return Member(e, scope);
    case ExprKind::kCall:
      return Bounded(e, Functions(*this).Call(e, scope));
    case ExprKind::kUnary:
      return Unary(e, scope);
    case ExprKind::kBinary:
      return Bounded(e, Binary(e, scope));
    case ExprKind::kTuple:
      return Tuple(e, scope);
    case ExprKind::kString:
    case ExprKind::kPid:
    case ExprKind::kIndex:
    case ExprKind::kList:
    case ExprKind::kQuantifier:
    case ExprKind::kConditional:
    case ExprKind::kFold:
    case ExprKind::kAny:
      break;
  }
  diagnostics_.Report(Kind::kRobotType, e.span, "expressions about robots know nothing of this kind");
  return {};
}

Value Evaluator::Literal(const Expr& e) {
  const auto number = Rational::Parse(e.text);
  if (!number) {
    diagnostics_.Report(Kind::kSyntaxNumber, e.span, "this number is too large or too small to be read");
    return {};
  }
  Value v = Quantity(arena_.Number(arena_.Real(), *number), {});
  v.any_dimension = number->IsZero();
  return v;
}

Value Evaluator::WithUnit(const Expr& e) {
  Value v = Visit(pool_[e.args[0]], {});
  if (v.kind != ValueKind::kQuantity) return v;
  if (e.text.empty()) {  // in SI units, of whatever is needed
    v.any_dimension = true;
    return v;
  }
  const lang::Unit* unit = lang::FindUnit(e.text);
  if (unit == nullptr) return {};
  const Rational size = Rational(unit->numerator) / Rational(unit->denominator);
  v.terms[0] = arena_.Mul(arena_.Number(arena_.Real(), size), v.terms[0]);
  if (unit->half_turns) v.terms[0] = arena_.Mul(v.terms[0], Pi(arena_));
  v.dimension = unit->dimension;
  v.any_dimension = false;
  return v;
}

Value Evaluator::Undeclared(const Expr& e, std::string_view name, const Scope& scope) {
  std::vector<std::string> names;
  for (const Scope* s = &scope; s != nullptr; s = s->outer) {
    for (const auto& [known, value] : s->names) names.push_back(known);
  }
  auto& report =
      diagnostics_.Report(Kind::kChoreoUndeclared, e.span, fmt::format("nothing is called `{}` here", name));
  if (const std::string near = lang::Suggest(name, names); !near.empty())
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(e.span, near);
  return {};
}

Value Evaluator::Named(const Expr& e, const Scope& scope) {
  if (const Value* v = scope.Find(e.text)) return *v;
  return Undeclared(e, e.text, scope);
}

Value Evaluator::Member(const Expr& e, const Scope& scope) {
  const Value base = Visit(pool_[e.args[0]], scope);
  if (base.kind == ValueKind::kError) return {};
  if (base.kind == ValueKind::kComponent) {
    if (const auto it = base.members->find(e.text); it != base.members->end()) return it->second;
    std::vector<std::string> names;
    for (const auto& [known, value] : *base.members) names.push_back(known);
    auto& report = diagnostics_.Report(Kind::kChoreoUndeclared, e.span,
                                       fmt::format("`{}` has no `{}`", pool_[e.args[0]].text, e.text));
    if (const std::string near = lang::Suggest(e.text, names); !near.empty())
      report.Help(fmt::format("did you mean `{}`?", near));
    return {};
  }
  if (IsVector(base) && e.text.size() == 1 && e.text[0] >= 'x' && e.text[0] <= 'z') {
    const auto i = static_cast<size_t>(e.text[0] - 'x');
    if (i < base.terms.size()) return Quantity(base.terms[i], base.dimension);
  }
  diagnostics_.Report(Kind::kRobotType, e.span,
                      fmt::format("this is {}, which has no `{}`", Describe(base), e.text));
  return {};
}

Value Evaluator::Unary(const Expr& e, const Scope& scope) {
  Value a = Visit(pool_[e.args[0]], scope);
  if (a.kind == ValueKind::kError) return {};
  if (e.text == "not") {
    if (a.kind != ValueKind::kBool) return WrongType(pool_[e.args[0]].span, a, "a formula");
    return Boolean(expr::Complement(arena_, a.terms[0]));
  }
  if (a.kind != ValueKind::kQuantity && a.kind != ValueKind::kCoordinates)
    return WrongType(pool_[e.args[0]].span, a, "a quantity");
  for (TermId& t : a.terms) t = arena_.Neg(t);
  a.squared.reset();
  return a;
}

Value Evaluator::Tuple(const Expr& e, const Scope& scope) {
  Value result;
  result.kind = ValueKind::kCoordinates;
  result.any_dimension = true;
  bool good = true;
  if (e.args.size() > 3) {
    diagnostics_.Report(Kind::kRobotType, e.span, "points have two or three coordinates");
    return {};
  }
  for (const ExprId id : e.args) {
    Value v = Visit(pool_[id], scope);
    if (v.kind != ValueKind::kQuantity) {
      WrongType(pool_[id].span, v, "a coordinate");
      good = false;
      continue;
    }
    if (!Agree(result, v)) {
      WrongUnit(pool_[id].span, v,
                fmt::format("a coordinate in {}, like the others,", UnitText(result.dimension)));
      good = false;
      continue;
    }
    result.terms.push_back(v.terms[0]);
  }
  return good ? result : Value{};
}

Value Evaluator::Binary(const Expr& e, const Scope& scope) {
  Value a = Visit(pool_[e.args[0]], scope);
  Value b = Visit(pool_[e.args[1]], scope);
  if (a.kind == ValueKind::kError || b.kind == ValueKind::kError) return {};
  const std::string& o = e.text;
  if (o == "and" || o == "or" || o == "implies") {
    if (a.kind != ValueKind::kBool) return WrongType(pool_[e.args[0]].span, a, "a formula");
    if (b.kind != ValueKind::kBool) return WrongType(pool_[e.args[1]].span, b, "a formula");
    if (o == "and") return Boolean(arena_.And(a.terms[0], b.terms[0]));
    if (o == "or") return Boolean(arena_.Or(a.terms[0], b.terms[0]));
    return Boolean(arena_.Or(expr::Complement(arena_, a.terms[0]), b.terms[0]));
  }
  if (o == "+" || o == "-") return Sum(e, std::move(a), std::move(b));
  if (o == "*") return Product(e, a, b);
  if (o == "/") return Quotient(e, a, b);
  if (o == "in" || o == "not in") {
    if (a.kind != ValueKind::kPoint) return WrongType(pool_[e.args[0]].span, a, "a point of the world");
    if (b.kind != ValueKind::kShape) return WrongType(pool_[e.args[1]].span, b, "a shape");
    const TermId in = robot::Contains(arena_, *b.shape, {a.terms[0], a.terms[1], a.terms[2]});
    return Boolean(o == "in" ? in : expr::Complement(arena_, in));
  }
  if (o == "==" || o == "!=") return Equality(e, std::move(a), std::move(b));
  if (o == "<" || o == "<=" || o == ">" || o == ">=") return Comparison(e, std::move(a), std::move(b));
  diagnostics_.Report(Kind::kRobotType, e.span, fmt::format("expressions about robots do not know `{}`", o));
  return {};
}

// A point minus a point, or plus coordinates, is taken coordinate by coordinate.
Value Evaluator::Sum(const Expr& e, Value a, Value b) {
  const bool minus = e.text == "-";
  const bool scalars = a.kind == ValueKind::kQuantity && b.kind == ValueKind::kQuantity;
  const bool vectors = IsVector(a) && IsVector(b) && a.terms.size() == b.terms.size() &&
                       !(a.kind == ValueKind::kCoordinates && b.kind == ValueKind::kPoint) &&
                       !(!minus && b.kind == ValueKind::kPoint);
  if (!scalars && !vectors) {
    const bool first = a.kind == ValueKind::kQuantity || IsVector(a);
    return WrongType(pool_[e.args[first ? 1 : 0]].span, first ? b : a,
                     first ? "something like " + Describe(a) : "a quantity");
  }
  if (!Agree(a, b))
    return WrongUnit(pool_[e.args[1]].span, b, fmt::format("something in {}", UnitText(a.dimension)));
  for (size_t i = 0; i < a.terms.size(); ++i)
    a.terms[i] = minus ? arena_.Sub(a.terms[i], b.terms[i]) : arena_.Add(a.terms[i], b.terms[i]);
  if (b.kind == ValueKind::kPoint) a.kind = ValueKind::kCoordinates;
  a.squared.reset();
  return a;
}

Value Evaluator::Product(const Expr& e, const Value& a, const Value& b) {
  if (a.kind == ValueKind::kFrame && b.kind == ValueKind::kFrame)
    return FrameAt(Compose(arena_, *a.pose, *b.pose));
  const bool scaled =
      a.kind == ValueKind::kQuantity && (b.kind == ValueKind::kQuantity || b.kind == ValueKind::kCoordinates);
  if (!scaled && !(a.kind == ValueKind::kCoordinates && b.kind == ValueKind::kQuantity)) {
    const bool first = a.kind == ValueKind::kQuantity;
    return WrongType(pool_[e.args[first ? 1 : 0]].span, first ? b : a, "a quantity");
  }
  const Value& factor = scaled ? a : b;
  Value result = scaled ? b : a;
  for (TermId& t : result.terms) t = arena_.Mul(factor.terms[0], t);
  result.dimension = a.dimension + b.dimension;
  result.any_dimension = a.any_dimension && b.any_dimension;
  result.squared.reset();
  return result;
}

Value Evaluator::Quotient(const Expr& e, const Value& a, const Value& b) {
  if (b.kind != ValueKind::kQuantity) return WrongType(pool_[e.args[1]].span, b, "a quantity");
  if (a.kind != ValueKind::kQuantity && a.kind != ValueKind::kCoordinates)
    return WrongType(pool_[e.args[0]].span, a, "a quantity");
  if (arena_.IsNumber(b.terms[0]) && arena_.number(b.terms[0]).IsZero()) {
    diagnostics_.Report(Kind::kRobotType, pool_[e.args[1]].span, "this divisor is zero");
    return {};
  }
  Value result = a;
  for (TermId& t : result.terms) t = arena_.Divide(t, b.terms[0]);
  result.dimension = a.dimension - b.dimension;
  result.any_dimension = a.any_dimension && b.any_dimension;
  result.squared.reset();
  return result;
}

Value Evaluator::Comparison(const Expr& e, Value a, Value b) {
  for (size_t i = 0; i < 2; ++i) {
    const Value& v = i == 0 ? a : b;
    if (v.kind != ValueKind::kQuantity) return WrongType(pool_[e.args[i]].span, v, "a quantity to compare");
  }
  if (!Agree(a, b))
    return WrongUnit(pool_[e.args[1]].span, b, fmt::format("something in {}", UnitText(a.dimension)));
  TermId left = a.terms[0], right = b.terms[0];
  // |p - q| < r as |p - q|^2 < r^2
  const auto square = [&](const Value& root, const Value& other) {
    return root.squared && arena_.IsNumber(other.terms[0]) && arena_.number(other.terms[0]) >= Rational(0);
  };
  if (square(a, b)) {
    left = *a.squared;
    right = Square(arena_, b.terms[0]);
  } else if (square(b, a)) {
    left = Square(arena_, a.terms[0]);
    right = *b.squared;
  }
  if (e.text[0] == '>') std::swap(left, right);
  // Angles are multiples of pi: their order is known.
  if (IsBelow(arena_, left, right)) return Boolean(arena_.True());
  if (IsBelow(arena_, right, left)) return Boolean(arena_.False());
  return Boolean(e.text.size() == 1 ? arena_.Lt(left, right) : arena_.Le(left, right));
}

Value Evaluator::Equality(const Expr& e, Value a, Value b) {
  const bool same = a.kind == b.kind && a.terms.size() == b.terms.size() && !a.terms.empty();
  if (!same) return WrongType(pool_[e.args[1]].span, b, fmt::format("something like {}", Describe(a)));
  if (!Agree(a, b))
    return WrongUnit(pool_[e.args[1]].span, b, fmt::format("something in {}", UnitText(a.dimension)));
  std::vector<TermId> equal;
  if (a.squared && arena_.IsNumber(b.terms[0]) && arena_.number(b.terms[0]) >= Rational(0)) {
    equal.push_back(arena_.Eq(*a.squared, Square(arena_, b.terms[0])));
  } else {
    for (size_t i = 0; i < a.terms.size(); ++i) equal.push_back(arena_.Eq(a.terms[i], b.terms[i]));
  }
  const TermId all = arena_.And(equal);
  return Boolean(e.text == "==" ? all : expr::Complement(arena_, all));
}

}  // namespace rondo::robot
