#pragma once

#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "lang/syntax_tree.h"
#include "robot/syntax/ast.h"
#include "robot/values/value.h"

/// Evaluates expressions about robots.
namespace rondo::robot {

/// Holds the names that an expression may use. Inner scopes hide outer ones, which must outlive them.
struct Scope {
  const Scope* outer = nullptr;
  Members names;

  /// Returns the value of a name, also from outer scopes; nullptr if it is not in scope.
  const Value* Find(std::string_view name) const;
};

/// Names a parameter of robots or their motions that may have any value between two bounds instead of its
/// own.
struct Loose {
  std::string name;
  expr::Rational least, most;  ///< in SI units
};

/// Gives expressions their meaning as terms, and checks dimensions: lengths, times and angles do not mix. A
/// bare 0 fits to everything. Every mismatch is reported where it stands (`robot-unit`, `robot-type`); names
/// that are not in scope as `choreo-undeclared`. The result of what was reported is kError.
class Evaluator {
 public:
  /// Evaluates expressions of `pool` to terms of `arena`. `loose` outlives it, if there is one.
  Evaluator(Arena& arena, const lang::ExprPool& pool, diag::Diagnostics& diagnostics,
            const Loose* loose = nullptr)
      : arena_(arena), pool_(pool), diagnostics_(diagnostics), loose_(loose) {}

  /// Returns the value of an expression under the names of `scope`.
  Value Evaluate(ExprId expr, const Scope& scope);
  /// Returns the term of a formula; true if it is missing or was reported.
  TermId Formula(ExprId expr, const Scope& scope, std::string_view what);
  /// Returns the term of a quantity with this dimension, in SI units; nothing after a report.
  std::optional<TermId> Measure(ExprId expr, const Scope& scope, lang::Dimension dimension,
                                std::string_view what);
  /// Returns the shape that an expression means; nothing after a report. `what` says in messages what it is
  /// for.
  std::optional<Shape> ShapeAt(ExprId expr, const Scope& scope, std::string_view what);
  /// Returns where something stands: the expression is a frame, or coordinates in `base`. Nothing after a
  /// report.
  std::optional<Pose> Place(ExprId expr, const Scope& scope, const Pose& base);

  Arena& arena() { return arena_; }
  const lang::ExprPool& pool() const { return pool_; }
  diag::Diagnostics& diagnostics() { return diagnostics_; }
  const Loose* loose() const { return loose_; }
  diag::Span SpanOf(ExprId expr) const { return pool_[expr].span; }

  /// Reports whether two values measure the same. If one fits to everything, it takes the dimension of the
  /// other.
  static bool Agree(Value& a, Value& b);
  /// Reports a value of the wrong dimension or kind, and returns kError.
  Value WrongUnit(diag::Span span, const Value& got, std::string_view wanted);
  Value WrongType(diag::Span span, const Value& got, std::string_view wanted);

 private:
  friend class Functions;
  Value Visit(const lang::Expr& e, const Scope& scope);
  Value Bounded(const lang::Expr& e, Value v);
  Value Literal(const lang::Expr& e);
  Value WithUnit(const lang::Expr& e);
  Value Named(const lang::Expr& e, const Scope& scope);
  Value Member(const lang::Expr& e, const Scope& scope);
  Value Unary(const lang::Expr& e, const Scope& scope);
  Value Binary(const lang::Expr& e, const Scope& scope);
  Value Sum(const lang::Expr& e, Value a, Value b);
  Value Product(const lang::Expr& e, const Value& a, const Value& b);
  Value Quotient(const lang::Expr& e, const Value& a, const Value& b);
  Value Comparison(const lang::Expr& e, Value a, Value b);
  Value Equality(const lang::Expr& e, Value a, Value b);
  Value Tuple(const lang::Expr& e, const Scope& scope);
  Value Undeclared(const lang::Expr& e, std::string_view name, const Scope& scope);

  Arena& arena_;
  const lang::ExprPool& pool_;
  diag::Diagnostics& diagnostics_;
  const Loose* loose_;
};

}  // namespace rondo::robot
