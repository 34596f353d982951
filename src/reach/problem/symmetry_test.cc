#include "reach/problem/symmetry.h"

#include <gtest/gtest.h>

#include "reach/problem/problem.h"

namespace rondo::reach {
namespace {

// A unicycle that is told a place (a, b) and a heading h.
struct Unicycle {
  expr::Arena arena;
  TermId x = Real("x"), y = Real("y"), theta = Real("theta"), steer = Real("steer");
  TermId a = Real("a"), b = Real("b"), h = Real("h"), clock = Real("clock");
  TermId dx = arena.Sub(x, a), dy = arena.Sub(y, b);
  TermId across = arena.Sub(arena.Mul(dy, Cos(h)), arena.Mul(dx, Sin(h)));
  Structure structure{
      &arena,
      {{x, 0}, {y, 0}, {theta, 1}, {a, 0, true}, {b, 0, true}, {h, 1, true}},
      {{x, Cos(theta)}, {y, Sin(theta)}, {theta, steer}, {steer, Number(0)}},
      {{x, x}, {y, y}, {theta, theta}, {steer, arena.Sub(arena.Neg(across), arena.Sub(theta, h))}},
      {arena.Add(arena.Mul(dx, dx), arena.Mul(dy, dy)), across, clock}};

  TermId Real(const char* name) { return arena.FreshConstant(name, arena.Real()); }
  TermId Number(int64_t n) { return arena.Number(arena.Real(), Rational(n)); }
  TermId Sin(TermId t) { return arena.Apply(expr::Elementary::kSin, {t}); }
  TermId Cos(TermId t) { return arena.Apply(expr::Elementary::kCos, {t}); }

  /// The parameters that do not matter: a, b, h.
  std::string Found() const {
    std::string names;
    for (const size_t c : RemovableParameters(structure).parameters)
      names += arena.symbol(arena.symbol_of(structure.coordinates[c].term)).name[0];
    return names;
  }
};

TEST(Symmetry, PlaceAndHeadingOfAUnicycle) {
  const Unicycle u;
  EXPECT_EQ(u.Found(), "abh");
  EXPECT_EQ(RemovableParameters(u.structure).moved.size(), 6u);
}

// Whatever makes one place differ from another is seen.
TEST(Symmetry, BrokenOnes) {
  const auto with = [](const std::function<void(Unicycle&)>& change) {
    Unicycle u;
    change(u);
    return u.Found();
  };
  const auto add = [](Unicycle& u, size_t rate, TermId term) {
    u.structure.rates[rate].second = u.arena.Add(u.structure.rates[rate].second, term);
  };
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 0, u.Number(1)); }), "ab") << "wind";
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 0, u.Real("wind")); }), "ab") << "a disturbance has a direction";
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 0, u.y); }), "a") << "a current that depends on y";
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 1, u.Sin(u.x)); }), "b");
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 2, u.Sin(u.theta)); }), "ab") << "a compass";
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.invariant.push_back(u.x); }), "b") << "a wall";
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.invariant.push_back(u.dx); }), "ab") << "a box around (a, b)";
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.invariant.push_back(u.a); }), "bh") << "turned about (a, b)";
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.coordinates[3].stays = true; }), "bh");
  EXPECT_EQ(with([&](Unicycle& u) {
              // Turned by half a turn less, a bearing jumps: nothing follows for headings.
              u.structure.jumps[3].second = u.arena.Sub(
                  u.arena.Apply(expr::Elementary::kAtan2, {u.arena.Neg(u.dy), u.arena.Neg(u.dx)}), u.theta);
            }),
            "ab");
  EXPECT_EQ(with([&](Unicycle& u) {
              const TermId far = u.arena.Le(u.x, u.Number(3));
              u.structure.jumps[3].second = u.arena.Ite(far, u.structure.jumps[3].second, u.Number(0));
            }),
            "b")
      << "a switch at a place";
  EXPECT_EQ(with([&](Unicycle& u) {
              const TermId far = u.arena.Le(u.dx, u.Number(3));
              u.structure.jumps[3].second = u.arena.Ite(far, u.structure.jumps[3].second, u.Number(0));
            }),
            "ab")
      << "a switch at a place that moves along";
  EXPECT_EQ(with([&](Unicycle& u) {
              u.structure.jumps[3].second =
                  u.arena.Apply(expr::Elementary::kMax, {u.across, u.arena.Sub(u.h, u.theta)});
            }),
            "abh");
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.jumps[1].second = u.Number(0); }), "a") << "y is reset";
  EXPECT_EQ(with([&](Unicycle& u) { add(u, 3, u.x); }), "b") << "what is held drifts";
  EXPECT_EQ(with([&](Unicycle& u) { u.structure.coordinates[2].kind = 7; }), "abh") << "theta only shifts";
}

// sin^2 + cos^2 = 1, and quotients by what does not change.
TEST(Symmetry, Identities) {
  Unicycle u;
  const auto square = [&](TermId t) { return u.arena.Mul(t, t); };
  const TermId along = u.arena.Add(u.arena.Mul(u.dx, u.Cos(u.h)), u.arena.Mul(u.dy, u.Sin(u.h)));
  u.structure.invariant = {u.arena.Sub(u.arena.Add(square(u.dx), square(u.dy)), square(along)),
                           u.arena.Divide(along, u.arena.Add(square(along), u.Number(1)))};
  EXPECT_EQ(u.Found(), "abh");
}

}  // namespace
}  // namespace rondo::reach
