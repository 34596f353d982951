#include "robot/model/control.h"

#include "expr/substitute.h"

namespace rondo::robot {

TermId Determined(Arena& arena, const Control& control, TermId term) {
  if (control.period) return term;
  const expr::Substitution laws(control.laws.begin(), control.laws.end());
  constexpr int kDeepest = 8;
  for (int depth = 0; depth < kDeepest && !laws.empty(); ++depth) {
    const TermId next = expr::Substitute(arena, term, laws);
    if (next == term) return term;
    term = next;
  }
  return term;
}

}  // namespace rondo::robot
