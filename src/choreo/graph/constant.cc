#include "choreo/graph/constant.h"

namespace rondo::choreo {

using expr::Rational;
using lang::Expr;
using lang::ExprId;
using lang::ExprKind;

namespace {

constexpr int kDeepest = 50;  // parameters whose defaults mention parameters

class Evaluator {
 public:
  Evaluator(const lang::ExprPool& pool, const Environment& environment)
      : pool_(pool), environment_(environment) {}

  std::optional<Quantity> Eval(ExprId id) {
    if (!id.valid()) return std::nullopt;
    const Expr& e = pool_[id];
    switch (e.kind) {
      case ExprKind::kInt:
      case ExprKind::kFloat:
        return Literal(e);
      case ExprKind::kQuantity:
        return WithUnit(e);
      case ExprKind::kName:
        return Named(e);
      case ExprKind::kUnary: {
        if (e.text != "-") return std::nullopt;
        auto a = Eval(e.args[0]);
        if (a) a->value = Rational(0) - a->value;
        return a && !a->infinite ? a : std::nullopt;
      }
      case ExprKind::kBinary:
        return Binary(e);
      default:
        return std::nullopt;  // everything else is no constant
    }
  }

 private:
  std::optional<Quantity> Literal(const Expr& e) const {
    const auto value = Rational::Parse(e.text);
    return value ? std::optional(Quantity{*value, {}, false}) : std::nullopt;
  }

  std::optional<Quantity> WithUnit(const Expr& e) {
    const lang::Unit* unit = lang::FindUnit(e.text);
    auto number = Eval(e.args[0]);
    if (!number || unit == nullptr || unit->half_turns) return std::nullopt;
    return Quantity{number->value * Rational(unit->numerator) / Rational(unit->denominator), unit->dimension,
                    false};
  }

  std::optional<Quantity> Named(const Expr& e) {
    if (e.text == "inf") return Quantity{Rational(0), {0, 1, 0}, true};
    const auto it = environment_.find(e.text);
    if (it == environment_.end() || ++depth_ > kDeepest) return std::nullopt;
    auto value = Eval(it->second);
    --depth_;
    return value;
  }

  std::optional<Quantity> Binary(const Expr& e) {
    const auto a = Eval(e.args[0]);
    const auto b = Eval(e.args[1]);
    if (!a || !b || a->infinite || b->infinite) return std::nullopt;
    const lang::Dimension& d = a->dimension;
    const lang::Dimension& f = b->dimension;
    if (e.text == "*")
      return Quantity{a->value * b->value, {d.length + f.length, d.time + f.time, d.angle + f.angle}, false};
    if (e.text == "/" && !b->value.IsZero())
      return Quantity{a->value / b->value, {d.length - f.length, d.time - f.time, d.angle - f.angle}, false};
    if (!(d == f)) return std::nullopt;
    if (e.text == "+") return Quantity{a->value + b->value, d, false};
    if (e.text == "-") return Quantity{a->value - b->value, d, false};
    return std::nullopt;
  }

  const lang::ExprPool& pool_;
  const Environment& environment_;
  int depth_ = 0;
};

}  // namespace

std::optional<Quantity> Constant(const lang::ExprPool& pool, ExprId expr, const Environment& environment) {
  return Evaluator(pool, environment).Eval(expr);
}

}  // namespace rondo::choreo
