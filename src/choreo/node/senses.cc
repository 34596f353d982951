#include "choreo/node/senses.h"

#include <cmath>

namespace rondo::choreo {

std::optional<std::vector<double>> ValuesOf(const expr::Arena& arena, const std::vector<robot::Value>& values,
                                            const expr::Numeric::Point& state) {
  expr::Numeric numeric(arena, state);
  std::vector<double> result;
  for (const robot::Value& value : values) {
    for (const expr::TermId t : value.terms) {
      const bool formula = arena.sort_of(t) == arena.Bool();
      result.push_back(formula ? (numeric.Violation(t) == 0 ? 1 : 0) : numeric(t));
      if (!std::isfinite(result.back())) return std::nullopt;
    }
  }
  return result;
}

}  // namespace rondo::choreo
