#pragma once

#include "robot/values/evaluate.h"

/// Evaluates the functions of expressions about robots. `kTable` in its sources is the list of them.
namespace rondo::robot {

/// Evaluates calls of the functions that expressions about robots may use; docs/motion.md lists them.
class Functions {
 public:
  explicit Functions(Evaluator& evaluator) : e_(evaluator), arena_(evaluator.arena_) {}

  /// Returns the value of a call; kError after a report: no such function, wrong number, kinds or units of
  /// arguments.
  Value Call(const lang::Expr& call, const Scope& scope);

 private:
  struct Arguments {
    const lang::Expr& call;
    std::vector<Value> values;
  };
  using Handler = Value (Functions::*)(Arguments& args);
  struct Entry {
    std::string_view name;
    size_t least, most;  ///< number of arguments
    Handler handler;
  };
  static const Entry kTable[];

  // Checked access to arguments; a failed check was reported.
  bool Need(const Arguments& args, size_t i, lang::Dimension dimension, std::string_view what);
  bool NeedQuantity(const Arguments& args, size_t i);
  bool NeedPositive(const Arguments& args, size_t i);
  bool NeedVector(const Arguments& args, size_t i);
  bool NeedFrame(const Arguments& args, size_t i);
  bool NeedShape(const Arguments& args, size_t i);
  bool NeedSame(Arguments& args, size_t i, size_t j);
  std::optional<Vector> NeedLengths(const Arguments& args, size_t i);
  diag::Span SpanOf(const Arguments& args, size_t i) const { return e_.SpanOf(args.call.args[i + 1]); }
  TermId Number(const expr::Rational& value) { return arena_.Number(arena_.Real(), value); }
  static Vector XYZ(const Value& v);
  bool Below(TermId a, TermId b);
  /// Returns the shape as a value, unless it has no points for certain, which is reported.
  Value Solid(const Arguments& args, Shape shape);
  Value Norm(const std::vector<TermId>& v, lang::Dimension dimension);

  // numbers
  Value Sqrt(Arguments& a);
  Value Abs(Arguments& a);
  Value Extreme(Arguments& a);
  Value Clamp(Arguments& a);
  Value Select(Arguments& a);
  Value Exponential(Arguments& a);
  Value Trigonometric(Arguments& a);
  Value InverseTrigonometric(Arguments& a);
  Value Atan2(Arguments& a);
  Value Power(Arguments& a);
  Value Near(Arguments& a);
  Value Between(Arguments& a);
  Value Linear(Arguments& a);
  Value SmoothStep(Arguments& a);
  // points
  Value Distance(Arguments& a);
  Value Length(Arguments& a);
  Value DotProduct(Arguments& a);
  Value Direction(Arguments& a);
  Value Point(Arguments& a);
  Value PointIn(Arguments& a);
  Value Coordinates(Arguments& a);
  Value Origin(Arguments& a);
  Value OnSegment(Arguments& a);
  // frames
  Value Translate(Arguments& a);
  Value Rotate(Arguments& a);
  // shapes
  Value Ball(Arguments& a);
  Value Cylinder(Arguments& a);
  Value Box(Arguments& a);
  Value Prism(Arguments& a);
  bool IsAbove(const Face& face, const Value& point);
  Value Hexagon(Arguments& a);
  Value HalfSpace(Arguments& a);
  Value HalfSphere(Arguments& a);
  Value Combined(Arguments& a);
  Value Inflated(Arguments& a);

  Evaluator& e_;
  Arena& arena_;
};

}  // namespace rondo::robot
