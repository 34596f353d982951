#include "sim/motions/payload.h"

#include "choreo/node/senses.h"
#include "choreo/prove/sampler.h"
#include "expr/substitute.h"

namespace rondo::sim::motions {

// Bools first; then numbers that satisfy what is left, as the state is.
std::optional<std::vector<double>> DrawPayload(expr::Arena& arena, const choreo::Node& message,
                                               const expr::Numeric::Point& state, std::mt19937_64& random) {
  expr::Substitution known;
  for (const auto& [variable, value] : state)
    known.emplace(variable, arena.Number(arena.Real(), expr::Rational::FromDouble(value)));
  const expr::TermId refinement = expr::Substitute(arena, message.refinement, known);
  constexpr int kTries = 20, kDraws = 200;
  for (int i = 0; i < kTries; ++i) {
    expr::Substitution formulas;
    for (const robot::Value& value : message.payload) {
      for (const expr::TermId t : value.terms) {
        if (arena.op(t) == expr::Op::kVariable && arena.sort_of(t) == arena.Bool())
          formulas.emplace(t, arena.Constant(random() % 2 == 0));
      }
    }
    const expr::TermId wanted = expr::Substitute(arena, refinement, formulas);
    const auto drawn = choreo::Sampler(arena, wanted).Draw(random, kDraws);
    if (!drawn) continue;
    expr::Numeric::Point point = state;
    for (const auto& [variable, value] : *drawn) point.insert_or_assign(variable, value);
    if (expr::Numeric::OnEdge(expr::Numeric(arena, point).Violation(wanted))) continue;
    std::vector<robot::Value> payload = message.payload;
    for (robot::Value& value : payload) {
      for (expr::TermId& t : value.terms) t = expr::Substitute(arena, t, formulas);
    }
    if (auto values = choreo::ValuesOf(arena, payload, point)) return values;
  }
  return std::nullopt;
}

}  // namespace rondo::sim::motions
