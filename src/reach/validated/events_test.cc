#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "reach/validated/prover.h"

namespace rondo::reach {
namespace {

// A problem with the discrete states `phase` and `count`, which begin as 0, last.
class Events : public testing::Test {
 protected:
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Num(double value) { return arena_.Number(arena_.Real(), Rational::FromDouble(value)); }
  TermId Is(TermId a, double value) { return arena_.Eq(a, Num(value)); }
  TermId Sum(TermId a, TermId b) { return arena_.Add(a, b); }
  TermId In(double phase, TermId then, TermId otherwise) {
    return arena_.Ite(Is(phase_, phase), then, otherwise);
  }

  Problem Make(std::vector<TermId> states, std::vector<TermId> rates, interval::Box initial, double horizon) {
    Problem p;
    p.name = "test";
    p.arena = &arena_;
    p.pinned.resize(states.size());
    p.states = std::move(states);
    p.rates = std::move(rates);
    p.initial = std::move(initial);
    for (const TermId t : {phase_, count_}) {
      p.states.push_back(t);
      p.rates.push_back(Num(0));
      p.initial.push_back(Interval::Point(0));
      p.pinned.emplace_back(Rational(0));
    }
    p.assume = arena_.True();
    p.horizon = Rational::FromDouble(horizon);
    return p;
  }
  // In a phase, as soon as something holds: another phase, and counted.
  void When(Problem& p, double phase, TermId condition, double next, bool counted = true) {
    Event e{arena_.And({Is(phase_, phase), condition}), {}};
    e.updates.resize(p.states.size());
    e.updates[p.states.size() - 2] = Num(next);
    if (counted) e.updates[p.states.size() - 1] = Sum(count_, Num(1));
    p.events.push_back(std::move(e));
  }
  void Always(Problem& p, TermId formula) { p.claims.push_back({"always", formula, Rational(0), p.horizon}); }
  void Finally(Problem& p, TermId formula) { p.claims.push_back({"post", formula, p.horizon, p.horizon}); }
  Outcome Decided(const Problem& p, size_t leaves = 60) {
    ProverOptions options;
    options.most_leaves = leaves;
    auto outcome = Decide(p, options, base::StopToken());
    EXPECT_TRUE(outcome.ok()) << (outcome.ok() ? "" : outcome.error().message);
    return outcome.ok() ? std::move(outcome).value() : Outcome(Undecided{});
  }

  expr::Arena arena_;
  const TermId phase_ = Var("phase"), count_ = Var("count");
  const TermId x_ = Var("x"), y_ = Var("y");
};

// x rises with the rate 2 up to 1, at tau = (1 - x0) / 2, then falls: at the end x = tau.
TEST_F(Events, TheInstantDependsOnTheStart) {
  const interval::Box start{{0, 0.2}};
  const auto make = [&](double least, double most) {
    Problem p = Make({x_}, {In(0, Num(2), Num(-1))}, start, 1);
    When(p, 0, arena_.Le(Num(1), x_), 1);
    Always(p, arena_.Le(x_, Num(1.0001)));
    Finally(p, arena_.And({arena_.Le(Num(least), x_), arena_.Le(x_, Num(most)), Is(count_, 1)}));
    return p;
  };
  const Outcome proved = Decided(make(0.3999, 0.5001));
  ASSERT_TRUE(std::holds_alternative<Proved>(proved));
  // A polynomial time of the event: the end is as sharp as that.
  const Leaf& leaf = std::get<Proved>(proved).leaves[0];
  EXPECT_EQ(std::get<Proved>(proved).leaves.size(), 1u);
  EXPECT_LT(leaf.final[0].Width(), 0.1001);
  EXPECT_TRUE(leaf.final[0].Contains(0.4) && leaf.final[0].Contains(0.5));
  const Outcome refuted = Decided(make(0.3999, 0.4999));
  ASSERT_TRUE(std::holds_alternative<Refuted>(refuted));
  EXPECT_TRUE(std::get<Refuted>(refuted).certain);
}

// A parabola that touches a line, or not: it is crossed twice or not at all, however the start is.
TEST_F(Events, WhatIsTouchedIsCrossedTwiceOrNotAtAll) {
  const auto make = [&] {
    Problem p = Make({x_, y_}, {y_, Num(2)}, {{0.9, 1.1}, {-2, -2}}, 2);  // x = x0 - 2 t + t^2, least x0 - 1
    When(p, 0, arena_.Le(x_, Num(0)), 1);
    When(p, 1, arena_.Lt(Num(0), x_), 0);
    return p;
  };
  Problem even = make();
  Finally(even, arena_.Or(Is(count_, 0), Is(count_, 2)));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(even)));
  Problem never = make();
  Finally(never, Is(count_, 0));
  EXPECT_TRUE(std::holds_alternative<Refuted>(Decided(never)));
  Problem always = make();
  Finally(always, Is(count_, 2));
  EXPECT_TRUE(std::holds_alternative<Refuted>(Decided(always)));
}

// What differs afterwards is followed on its own.
TEST_F(Events, BranchesOfATouchAreFollowed) {
  const auto make = [&](double bound) {
    const TermId z = Var("z");
    Problem p = Make({x_, y_, z}, {y_, Num(2), In(1, Num(1), Num(0))}, {{0.9, 1.1}, {-2, -2}, {0, 0}}, 2);
    When(p, 0, arena_.Le(x_, Num(0)), 1);
    Finally(p, arena_.Le(z, Num(bound)));
    return p;
  };
  // Inside from t = 1 - sqrt(1 - x0) on, for 0.9: 0.684; so z <= 1.32 at the end.
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(make(1.34))));
  EXPECT_FALSE(std::holds_alternative<Proved>(Decided(make(1.31))));
}

// What fails while the set is brought to one instant again leaves nothing behind.
TEST_F(Events, ClaimsThatFailJustAfterAnEvent) {
  Problem p = Make({x_}, {Num(1)}, {{-0.3, 0}}, 1);
  When(p, 0, arena_.Le(Num(0.3), x_), 1);
  Always(p, arena_.Le(x_, Num(0.9)));
  const Outcome outcome = Decided(p);
  ASSERT_TRUE(std::holds_alternative<Refuted>(outcome));
}

// A count of events that is reached only at an event: the refutation does not depend on its exact instant.
TEST_F(Events, CountsAreRefuted) {
  Problem p = Make({x_}, {In(0, Num(1), Num(-1))}, {{0, 0}}, 2);
  When(p, 0, arena_.Le(Num(1), x_), 1);
  When(p, 1, arena_.Le(x_, Num(0.9)), 0);
  Always(p, arena_.Le(count_, Num(9)));
  EXPECT_TRUE(std::holds_alternative<Refuted>(Decided(p)));
}

// x = 1 - (t - tau) later on: a query along the polynomials knows how it depends on the start.
TEST_F(Events, TubesAnswerQueries) {
  const TermId start = Var("start");
  Problem p = Make({x_, start}, {In(0, Num(2), Num(-1)), Num(0)}, {{0, 0.2}, {0, 0.2}}, 2);
  p.copy_of = {std::nullopt, size_t{0}, std::nullopt, std::nullopt};
  When(p, 0, arena_.Le(Num(1), x_), 1);
  Always(p, arena_.Le(x_, Num(2)));
  const Outcome outcome = Decided(p);
  ASSERT_TRUE(std::holds_alternative<Proved>(outcome));
  const TermId twice = arena_.Mul(Num(2), x_);
  const auto answers = RangesOn(p, std::get<Proved>(outcome),
                                {{arena_.Add(twice, start), 1.75, 2},  // 2 (1 - t + tau) + x0 = 3 - 2 t
                                 {arena_.Sub(x_, start), 0, 0.25},     // 2 t
                                 {x_, 0, 2}},
                                {}, base::StopToken());
  ASSERT_TRUE(answers.ok());
  const auto near = [](Interval i, double lo, double hi) {
    return i.lo <= lo && i.lo > lo - 1e-3 && i.hi >= hi && i.hi < hi + 1e-3;
  };
  EXPECT_TRUE(near(answers.value()[0], -1, -0.5)) << answers.value()[0].lo << ' ' << answers.value()[0].hi;
  EXPECT_TRUE(near(answers.value()[1], 0, 0.5)) << answers.value()[1].lo << ' ' << answers.value()[1].hi;
  EXPECT_TRUE(answers.value()[2].Contains({-0.6, 1}));
  EXPECT_LT(answers.value()[2].hi, 1.1);
}

TEST_F(Events, WhatHoldsAtTheStartHappensThen) {
  Problem p = Make({x_}, {In(2, Num(1), Num(-1))}, {{0, 1}}, 1);
  When(p, 0, arena_.Le(Num(-1), x_), 1);  // both at once
  When(p, 1, arena_.Le(Num(-2), x_), 2);
  Always(p, arena_.Le(Num(-1e-6), x_));
  Finally(p, arena_.And({Is(phase_, 2), Is(count_, 2)}));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
}

TEST_F(Events, WithoutEndTheyEstablishNothing) {
  Problem p = Make({x_}, {Num(1)}, {{0, 0.1}}, 1);
  When(p, 0, arena_.Le(Num(0.5), x_), 1);
  When(p, 1, arena_.Le(Num(0.5), x_), 0);
  Always(p, arena_.Le(x_, Num(10)));
  EXPECT_TRUE(std::holds_alternative<Undecided>(Decided(p, 4)));
}

TEST_F(Events, SetOnlyWhatIsDiscrete) {
  Problem p = Make({x_}, {Num(1)}, {{0, 0.1}}, 1);
  Event e{arena_.Le(Num(0.5), x_), {}};
  e.updates.resize(p.states.size());
  e.updates[0] = Num(0);
  p.events.push_back(e);
  Always(p, arena_.Le(x_, Num(10)));
  const auto outcome = Decide(p, {}, base::StopToken());
  ASSERT_FALSE(outcome.ok());
  EXPECT_NE(outcome.error().message.find("`x`, which changes by itself"), std::string::npos);
}

// What is known of rates does not outlive the instant at which a controller changes them: once x has left a
// parabola through zero it rises, until the controller acts.
TEST_F(Events, KnowledgeOfRatesEndsWhereTheControllerActs) {
  const TermId u = Var("u");
  for (const double drop : {0.0, 10.0}) {
    Problem p = Make({x_, y_, u}, {Sum(u, y_), Num(2), Num(0)}, {{0.9, 1.1}, {-2, -2}, {0, 0}}, 2);
    When(p, 0, arena_.Le(x_, Num(0)), 1);
    When(p, 1, arena_.Lt(Num(0), x_), 0);
    p.controller.emplace();
    p.controller->period = *Rational::Parse("1.5");
    p.controller->updates.resize(p.states.size());
    p.controller->updates[2] = arena_.Ite(arena_.Le(Num(0), y_), Num(-drop), Num(0));
    Finally(p, arena_.Le(count_, Num(2)));
    ProverOptions options;
    options.samples = 0;
    options.most_leaves = 4;
    const auto outcome = Decide(p, options, base::StopToken());
    ASSERT_TRUE(outcome.ok());
    EXPECT_EQ(std::holds_alternative<Proved>(outcome.value()), drop == 0) << drop;
  }
}

// What decides may be one of several comparisons.
TEST_F(Events, ConditionsOfSeveralComparisons) {
  const TermId fast = arena_.Le(Num(0.8), arena_.Apply(expr::Elementary::kAbs, {y_}));
  const TermId slow = arena_.Le(arena_.Apply(expr::Elementary::kAbs, {y_}), Num(0.2));
  // x = a cos t, y = -a sin t until |y| = 0.8; then x and y stay; both claims are about that instant.
  const TermId zero = Num(0);
  Problem p = Make({x_, y_}, {In(0, y_, zero), In(0, arena_.Neg(x_), zero)}, {{1, 1.1}, {0, 0}}, 2);
  When(p, 0, fast, 1);
  When(p, 1, slow, 2);
  Finally(p, arena_.And({Is(count_, 1), arena_.Le(y_, Num(-0.7999)), arena_.Le(Num(0.5999), x_)}));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.claims[0].formula = arena_.Le(y_, Num(-0.8001));
  EXPECT_FALSE(std::holds_alternative<Proved>(Decided(p)));
  // x falls from 1 to 0 while y rises from -1: both conditions are met, the second of them at 1 / a.
  for (const bool both : {true, false}) {
    Problem q = Make({x_, y_}, {Num(-1), Num(0.5)}, {{1, 1.05}, {-0.95, -0.9}}, 3);
    const std::vector<TermId> parts{arena_.Le(x_, zero), arena_.Le(zero, y_)};
    When(q, 0, both ? arena_.And(parts) : arena_.Or(parts), 1);
    q.rates[1] = In(0, Num(0.5), zero);
    Finally(q, both ? arena_.Le(arena_.Apply(expr::Elementary::kAbs, {y_}), Num(1e-6))
                    : arena_.And({arena_.Le(y_, Num(-0.37)), Is(count_, 1)}));
    EXPECT_TRUE(std::holds_alternative<Proved>(Decided(q))) << both;
    q.claims[0].formula = both ? arena_.Le(y_, Num(-1e-6)) : arena_.Le(y_, Num(-0.43));
    EXPECT_FALSE(std::holds_alternative<Proved>(Decided(q))) << both;
  }
}

// On each side of x = 0 another flow. If both lead through, the mode is the side; else nothing is known of
// it.
TEST_F(Events, WithoutHysteresis) {
  for (const bool strict : {true, false}) {
    const auto make = [&](double before, double after, double horizon = 3) {
      Problem p = Make({x_, y_}, {In(0, Num(before), Num(after)), Num(1)}, {{1, 1.5}, {0, 0}}, horizon);
      When(p, 0, arena_.Le(x_, Num(0)), 1, false);
      When(p, 1, strict ? arena_.Lt(Num(0), x_) : arena_.Le(Num(0), x_), 0, false);
      return p;
    };
    Problem through = make(-1, -2);
    Finally(through, arena_.And({Is(phase_, 1), arena_.Le(x_, Num(-2.999)), arena_.Le(Num(-4.001), x_)}));
    EXPECT_TRUE(std::holds_alternative<Proved>(Decided(through)));
    through.claims[0].formula = arena_.Le(x_, Num(-3.1));
    EXPECT_FALSE(std::holds_alternative<Proved>(Decided(through)));
    Problem back = make(-1, 2, 1.52);  // slides along x = 0
    Finally(back, Is(phase_, 1));
    ProverOptions options;
    options.samples = 0;
    options.most_leaves = 1;
    const auto slides = Decide(back, options, base::StopToken());
    EXPECT_TRUE(slides.ok() && !std::holds_alternative<Proved>(slides.value()));
    Problem counted = make(-1, -2);
    counted.events[1].updates[3] = Sum(count_, Num(1));  // toggles at the instant may be counted
    Finally(counted, Is(count_, 0));
    EXPECT_EQ(std::holds_alternative<Proved>(Decided(counted, 1)), strict);
  }
}

// Random systems that switch between linear flows: no trajectory leaves its tube, and no bound that one
// exceeds is proved.
TEST_F(Events, RandomSwitchedSystems) {
  std::mt19937_64 random;
  const auto uniform = [&](double lo, double hi) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    return std::round((lo + u * (hi - lo)) * 1024) / 1024;
  };
  size_t proofs = 0;
  size_t events = 0;
  const unsigned rounds = std::getenv("RONDO_CASES") == nullptr ? 10 : 1000;
  for (unsigned round = 0; round < rounds; ++round) {
    random.seed(round);
    const auto linear = [&] {
      return arena_.Add({arena_.Mul(Num(uniform(-1.5, 1.5)), x_), arena_.Mul(Num(uniform(-1.5, 1.5)), y_),
                         Num(uniform(-1, 1))});
    };
    const double cx = uniform(-1, 1);
    const double cy = uniform(-1, 1);
    const double radius = round % 4 == 3 ? 0.2 : 0.05;
    Problem p = Make({x_, y_},
                     {In(0, linear(), In(1, linear(), linear())), In(0, linear(), In(1, linear(), linear()))},
                     {{cx - radius, cx + radius}, {cy - radius, cy + radius}}, 2);
    const auto term = [&] { return round % 2 == 0 ? linear() : arena_.Add(arena_.Mul(x_, x_), linear()); };
    if (round % 5 == 1) {  // two modes, on the two sides of one boundary
      const TermId boundary = term();
      When(p, 0, arena_.Le(boundary, Num(0)), 1, round % 2 == 0);
      When(p, 1, round % 3 == 0 ? arena_.Le(Num(0), boundary) : arena_.Lt(Num(0), boundary), 0, false);
    } else {
      for (int e = 0; e < 3; ++e) {
        TermId condition = e % 2 == 0 ? arena_.Le(term(), Num(0)) : arena_.Lt(term(), Num(0));
        if (round % 5 == 2) condition = arena_.And({condition, arena_.Le(linear(), Num(1))});
        if (round % 5 == 3)
          condition =
              arena_.Or(condition, arena_.Le(Num(1), arena_.Apply(expr::Elementary::kAbs, {linear()})));
        When(p, e, condition, (e + 1) % 3);
      }
    }
    Always(p, arena_.Le(x_, Num(50)));
    const Outcome outcome = Decided(p, 6);
    const auto* proved = std::get_if<Proved>(&outcome);
    if (proved == nullptr) continue;
    ++proofs;
    auto found = Trajectories::Of(p);
    ASSERT_TRUE(found.ok());
    Trajectories run = std::move(found).value();
    for (int k = 0; k < 40; ++k) {
      Execution execution;
      for (size_t i = 0; i < p.states.size(); ++i) {
        const Interval side = p.initial[i];
        const double u = k < 4 ? ((k >> i) & 1) : static_cast<double>(random() >> 11) * 0x1p-53;
        execution.start.push_back(std::min(side.hi, side.lo + u * (side.hi - side.lo)));
      }
      run.Run(execution, 0.02, [&](double t, std::span<const double> x) {
        bool inside = false;
        for (const Leaf& leaf : proved->leaves) {
          bool own = true;
          for (size_t i = 0; i < x.size(); ++i) own = own && leaf.initial[i].Contains(execution.start[i]);
          for (const TubeSegment& s : leaf.tube) {
            if (!own || t < s.from - 1e-9 || t > s.to + 1e-9) continue;
            bool in = true;
            for (size_t i = 0; i < x.size(); ++i)
              in = in && x[i] >= s.during[i].lo - 1e-9 && x[i] <= s.during[i].hi + 1e-9;
            inside = inside || in;
          }
        }
        if (t == 0) inside = true;  // before the events of the start
        EXPECT_TRUE(inside) << "system " << round << ", trajectory " << k << ", at " << t;
        events += x[2] > 0 ? 1 : 0;
        return inside;
      });
    }
  }
  EXPECT_GE(proofs, 5u);
  EXPECT_GT(events, 100u);
}

}  // namespace
}  // namespace rondo::reach
