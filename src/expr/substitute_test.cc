#include "expr/substitute.h"

#include <gtest/gtest.h>

namespace rondo::expr {
namespace {

TEST(Substitution, HappensOnceEvenIfTheResultIsAKeyAgain) {
  Arena arena;
  const auto variable = [&](const char* name) {
    return arena.Variable(arena.Declare(name, {}, arena.Real()));
  };
  const TermId x = variable("x");
  const TermId y = variable("y");
  const TermId one = arena.Number(arena.Real(), Rational(1));
  // (x - 1)[x + 1 / x] is x, which is not looked at again.
  EXPECT_EQ(Substitute(arena, arena.Sub(x, one), {{x, arena.Add(x, one)}}), x);
  // (x - y)[y / x, 0 / y] is y.
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  EXPECT_EQ(Substitute(arena, arena.Sub(x, y), {{x, y}, {y, zero}}), y);
  // Swapping.
  EXPECT_EQ(Substitute(arena, arena.Le(x, y), {{x, y}, {y, x}}), arena.Le(y, x));
}

}  // namespace
}  // namespace rondo::expr
