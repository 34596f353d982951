#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reach/certify/checker.h"
#include "reach/certify/models/errors.h"
#include "reach/certify/models/reach_set.h"
#include "reach/problem/numeric.h"

namespace rondo::reach::certify {
namespace {

using expr::Elementary;

double Uniform(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

TEST(TaylorCoefficients, AreThoseOfTheFunctions) {
  std::vector<Interval> out(6);
  // atan(1 + u) = pi/4 + u/2 - u^2/4 + u^3/12 + 0 u^4 - u^5/40
  ASSERT_TRUE(TaylorCoefficients(CodeOp::kAtan, Interval::Point(1), out));
  const double atan[] = {std::atan(1.0), 0.5, -0.25, 1.0 / 12, 0, -1.0 / 40};
  for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(out[k].Middle(), atan[k], 1e-12) << k;
  // sqrt(4 + u) = 2 + u/4 - u^2/64 + u^3/512
  ASSERT_TRUE(TaylorCoefficients(CodeOp::kRoot, Interval::Point(4), out));
  const double root[] = {2, 0.25, -1.0 / 64, 1.0 / 512};
  for (size_t k = 0; k < 4; ++k) EXPECT_TRUE(out[k].Contains(root[k])) << k;
  // log(2 + u) = log 2 + u/2 - u^2/8 + u^3/24
  ASSERT_TRUE(TaylorCoefficients(CodeOp::kLog, Interval::Point(2), out));
  EXPECT_NEAR(out[3].Middle(), 1.0 / 24, 1e-15);
  ASSERT_TRUE(TaylorCoefficients(CodeOp::kReciprocal, Interval::Point(-2), out));
  EXPECT_TRUE(out[3].Contains(-1.0 / 16));
  EXPECT_FALSE(TaylorCoefficients(CodeOp::kReciprocal, {-1, 1}, out));
  EXPECT_FALSE(TaylorCoefficients(CodeOp::kLog, {0, 1}, out));
  EXPECT_FALSE(TaylorCoefficients(CodeOp::kRoot, {0, 1}, out));
}

TEST(TaylorCoefficients, OfTheArctangentAreBounded) {
  std::vector<Interval> out(9);
  for (const double x : {-3.0, -0.4, 0.0, 1.0, 7.0}) {
    ASSERT_TRUE(TaylorCoefficients(CodeOp::kAtan, Interval::Point(x), out));
    for (size_t k = 1; k < 9; ++k)
      EXPECT_LE(std::fabs(out[k].Middle()), ArctangentBound({x - 0.5, x + 0.5}, k) * (1 + 1e-12));
  }
}

// The value of a polynomial in s and t, and how far a model may be from it.
double ValueAt(const Algebra& algebra, const Model& model, const std::vector<double>& s, double t) {
  double sum = 0;
  for (size_t m = 0; m < algebra.basis().size(); ++m) {
    double term = 1;
    for (size_t k = 0; k < s.size(); ++k) term *= std::pow(s[k], algebra.basis().Exponents(m)[k]);
    double in_time = 0;
    for (size_t p = algebra.order() + 1; p-- > 0;)
      in_time = in_time * t + model.polynomial[m * (algebra.order() + 1) + p];
    sum += term * in_time;
  }
  return sum;
}

// Whatever is computed with models holds at every point.
TEST(Models, EncloseWhatTheyAreComputedFrom) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 60; ++round) {
    const size_t symbols = round % 3;
    const Basis basis(symbols, 1 + round % 4);
    const Algebra algebra(basis, 3 + round % 3);
    const auto make = [&](double middle) {
      Model m = algebra.Constant(Interval::Point(middle));
      const double size = 0.5 / static_cast<double>(m.polynomial.size());
      for (size_t i = 1; i < m.polynomial.size(); ++i) m.polynomial[i] = Uniform(random, -size, size);
      algebra.Seal(m);
      return m;
    };
    const Model a = make(Uniform(random, 1, 2));
    const Model b = make(Uniform(random, -1, 1));
    const LinearPart none{0, 0, 0};
    const Model product = algebra.Product(a, b);
    const Model square = algebra.Product(a, a);
    const Model linear = algebra.Linear(std::vector<LinearPart>{{2, 0, 0}, {-0.3, 0, 1}}, none, {a, b});
    const auto angle = algebra.Angle(b, a);
    ASSERT_TRUE(angle);
    struct Case {
      CodeOp op;
      double (*function)(double);
    };
    const Case cases[] = {{CodeOp::kReciprocal, [](double x) { return 1 / x; }},
                          {CodeOp::kRoot, [](double x) { return std::sqrt(x); }},
                          {CodeOp::kSine, [](double x) { return std::sin(x); }},
                          {CodeOp::kCosine, [](double x) { return std::cos(x); }},
                          {CodeOp::kExp, [](double x) { return std::exp(x); }},
                          {CodeOp::kLog, [](double x) { return std::log(x); }},
                          {CodeOp::kAtan, [](double x) { return std::atan(x); }}};
    std::vector<Model> functions;
    for (const Case& c : cases) {
      const auto model = algebra.Function(c.op, a);
      ASSERT_TRUE(model);
      functions.push_back(*model);
    }
    for (int sample = 0; sample < 20; ++sample) {
      std::vector<double> s(symbols);
      for (double& x : s) x = sample == 0 ? 1 : Uniform(random, -1, 1);
      const double t = sample == 0 ? 1 : Uniform(random, 0, 1);
      const double x = ValueAt(algebra, a, s, t);
      const double y = ValueAt(algebra, b, s, t);
      const auto holds = [&](const Model& m, double value) {
        EXPECT_NEAR(ValueAt(algebra, m, s, t), value, m.error + 1e-14);
        EXPECT_TRUE((algebra.Bounds(m) + Around(1e-14)).Contains(value));
        EXPECT_TRUE((algebra.Range(m, 0, 1) + Around(1e-14)).Contains(value));
        EXPECT_TRUE((algebra.Range(m, t, t) + Around(1e-14)).Contains(value));
      };
      holds(product, x * y);
      holds(square, x * x);
      holds(linear, 2 * x - 0.3 * y);
      holds(*angle, std::atan2(y, x));
      for (size_t f = 0; f < functions.size(); ++f) holds(functions[f], cases[f].function(x));
    }
  }
}

TEST(ReachSets, AreTheUnionOfTheirHalves) {
  std::mt19937_64 random(4);
  const auto basis = std::make_shared<const Basis>(2, 3);
  ReachSet set;
  set.basis = basis;
  set.generators.resize(1, 0);
  set.polynomials.emplace_back(basis->size());
  for (double& c : set.polynomials[0]) c = Uniform(random, -1, 1);
  const Algebra algebra(*basis, 0);
  for (const bool upper : {false, true}) {
    const ReachSet half = set.Half(1, upper);
    for (int sample = 0; sample < 50; ++sample) {
      const double s = Uniform(random, -1, 1);
      const double r = Uniform(random, -1, 1);
      const double whole =
          ValueAt(algebra, algebra.InSymbols(set.polynomials[0]), {s, (r + (upper ? 1 : -1)) / 2}, 0);
      EXPECT_NEAR(ValueAt(algebra, algebra.InSymbols(half.polynomials[0]), {s, r}, 0), whole, 1e-13);
    }
  }
}

TEST(ReachSets, StayEnclosedWithFewerColumns) {
  std::mt19937_64 random(5);
  ReachSet set;
  set.basis = std::make_shared<const Basis>(0, 0);
  set.polynomials.assign(3, {0.0});
  set.generators = Eigen::MatrixXd::Random(3, 40);
  ReachSet fewer = set;
  fewer.Reduce(20);
  EXPECT_LE(fewer.generators.cols(), 13);
  // The support in any direction does not become smaller.
  for (int sample = 0; sample < 100; ++sample) {
    const Eigen::VectorXd d = Eigen::VectorXd::Random(3);
    EXPECT_GE((d.transpose() * fewer.generators).cwiseAbs().sum(),
              (d.transpose() * set.generators).cwiseAbs().sum() * (1 - 1e-12));
  }
}

TEST(Errors, GrowAtLeastAsTheyDo) {
  // e' = -2 e + d, |d| <= 1 + t: from 1, at most exp(-2) + integral.
  ErrorRates rates{Eigen::MatrixXd::Constant(1, 1, -2), Eigen::MatrixXd::Zero(1, 1)};
  Push push{{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1)}};
  ErrorFlow flow;
  ASSERT_TRUE(PropagateErrors(rates, Eigen::MatrixXd::Ones(1, 1), push, flow));
  double exact = std::exp(-2.0);
  for (int i = 0; i < 100000; ++i) {
    const double t = (i + 0.5) / 100000;
    exact += std::exp(-2 * (1 - t)) * (1 + t) / 100000;
  }
  const double at_end = flow.generators.cwiseAbs().sum();
  EXPECT_GE(at_end, exact);
  EXPECT_LE(at_end, 3 * exact);
  EXPECT_GE(flow.most[0], 1);
  // A turn: the columns turn with it, and no error is added to speak of.
  rates.centre.resize(2, 2);
  rates.centre << 0, -3, 3, 0;
  rates.radius = Eigen::MatrixXd::Zero(2, 2);
  ASSERT_TRUE(PropagateErrors(rates, Eigen::MatrixXd::Identity(2, 2), {}, flow));
  EXPECT_NEAR(flow.generators(0, 0), std::cos(3), 1e-12);
  EXPECT_NEAR(flow.generators(1, 0), std::sin(3), 1e-12);
  EXPECT_LT(flow.added.maxCoeff(), 1e-12);
}

class Problems : public testing::Test {
 protected:
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Num(double value) { return arena_.Number(arena_.Real(), Rational::FromDouble(value)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }

  Problem Make(std::vector<TermId> states, std::vector<TermId> rates, interval::Box initial, double horizon) {
    Problem p;
    p.name = "test";
    p.arena = &arena_;
    p.states = std::move(states);
    p.rates = std::move(rates);
    p.initial = std::move(initial);
    p.assume = arena_.True();
    p.horizon = Rational::FromDouble(horizon);
    return p;
  }
  void Always(Problem& p, TermId formula) { p.claims = {{"always", formula, Rational(0), p.horizon}}; }
  // All of it in steps of this length.
  static Certificate Even(double length, size_t degree = 3) {
    return {{{{}, {{.length = length, .degree = degree}}}}};
  }
  static Acceptance Checked(const Problem& p, const Certificate& c) {
    return Check(p, c, 1, base::StopToken());
  }

  expr::Arena arena_;
};

// Claims near the truth: what trajectories break is never accepted, and what holds by a margin is.
TEST_F(Problems, AreNeverAcceptedWhereTrajectoriesBreakThem) {
  std::mt19937_64 random(11);
  const TermId x = Var("x"), y = Var("y"), w = Var("w");
  int accepted = 0;
  for (int round = 0; round < 10; ++round) {
    const auto c = [&] { return Num(std::ldexp(std::round(Uniform(random, -1, 1) * 64), -6)); };
    const TermId parts[] = {x,
                            y,
                            arena_.Mul(x, y),
                            Of(Elementary::kSin, {x}),
                            Of(Elementary::kAbs, {y}),
                            Of(Elementary::kMax, {x, y}),
                            arena_.Divide(x, arena_.Add(Num(3), arena_.Mul(y, y))),
                            Of(Elementary::kExp, {arena_.Sub(y, Num(1))}),
                            w};
    const auto sum = [&] {
      TermId all = c();
      for (int k = 0; k < 3; ++k) all = arena_.Add(all, arena_.Mul(c(), parts[random() % std::size(parts)]));
      return all;
    };
    Problem p = Make({x, y}, {sum(), sum()}, {{-0.25, 0.125}, {0.5, 0.75}}, 1);
    p.inputs.push_back({w, {-0.125, 0.25}});
    if (round % 2 == 1) {
      p.controller.emplace();
      p.controller->period = *Rational::Parse("0.25");
      p.controller->updates = {std::nullopt, Of(Elementary::kMin, {sum(), Num(0.5)})};
    }
    const TermId seen = round % 3 == 0 ? arena_.Add(x, y) : x;
    Always(p, arena_.Le(seen, Num(1e9)));
    auto made = Trajectories::Of(p);
    ASSERT_TRUE(made.ok());
    Trajectories run = std::move(made).value();
    double most = -HUGE_VAL;
    for (int sample = 0; sample < 40; ++sample) {
      const auto end = [&](Interval i) {
        return sample < 8 ? (random() % 2 == 0 ? i.lo : i.hi) : Uniform(random, i.lo, i.hi);
      };
      Execution execution{{end(p.initial[0]), end(p.initial[1])}, {}, 0.1};
      for (int k = 0; k < 10; ++k) execution.inputs.push_back({end(p.inputs[0].bounds)});
      run.Run(execution, 0.01, [&](double, std::span<const double> state) {
        most = std::max(most, round % 3 == 0 ? state[0] + state[1] : state[0]);
        return true;
      });
    }
    ASSERT_TRUE(std::isfinite(most));
    Always(p, arena_.Le(seen, Num(most - 1e-6 * (1 + std::fabs(most)))));
    EXPECT_FALSE(Checked(p, Even(0.02)).accepted) << round;
    Always(p, arena_.Le(seen, Num(most + 0.5)));
    accepted += Checked(p, Even(0.02)).accepted ? 1 : 0;
  }
  EXPECT_GE(accepted, 8);
}

TEST_F(Problems, NeedAllOfTheInitialSet) {
  const TermId x = Var("x");
  Problem p = Make({x}, {arena_.Neg(x)}, {{-1, 1}}, 1);
  Always(p, arena_.Le(x, Num(1.0)));
  p.assume = arena_.Le(x, Num(1.0));
  const std::vector<PartRecord::Step> steps{{.length = 0.05, .degree = 2}};
  const PartRecord lower{{{0, false}}, steps};
  const PartRecord upper{{{0, true}}, steps};
  EXPECT_TRUE(Checked(p, {{lower, upper}}).accepted);
  EXPECT_FALSE(Checked(p, {{lower}}).accepted);
  EXPECT_FALSE(Checked(p, {{lower, lower}}).accepted);
  EXPECT_FALSE(Checked(p, {}).accepted);
  EXPECT_FALSE(Checked(p, {{lower, {{{0, true}}, {}}}}).accepted);     // no steps
  EXPECT_FALSE(Checked(p, {{lower, {{{7, true}}, steps}}}).accepted);  // no such state
  EXPECT_FALSE(Checked(p, {{{{}, steps}, lower, upper}}).accepted);    // a part of a part
  for (const double length : {0.0, -1.0, 1e300, std::nan("")})
    EXPECT_TRUE(
        Checked(p, {{{{}, {{.length = length, .degree = 2}, {.length = 0.1, .degree = 2}}}}}).accepted)
        << length;
}

TEST_F(Problems, MayHoldWithEqualityAtTheStart) {
  // x' = -x + y, y' = -2 y, from x = y = 1: x falls from 1 on, after it has stood still for a moment.
  const TermId x = Var("x"), y = Var("y");
  Problem p = Make({x, y}, {arena_.Sub(y, x), arena_.Mul(Num(-2), y)}, {{0.5, 1}, {0.25, 0.25}}, 1);
  p.assume = arena_.Le(x, Num(1.0));
  Always(p, arena_.Le(x, Num(1.0)));
  EXPECT_TRUE(Checked(p, Even(0.02)).accepted);
  p.assume = arena_.True();  // then 1 is only what a box says
  Always(p, arena_.Lt(x, Num(1.0)));
  EXPECT_FALSE(Checked(p, Even(0.02)).accepted);
}

// A tank that fills until a switch closes the tap.
TEST_F(Problems, WithAnEventNeedItsTime) {
  const TermId x = Var("x"), tap = Var("tap");
  Problem p =
      Make({x, tap}, {arena_.Ite(arena_.Le(tap, Num(0)), Num(1), Num(-0.5)), Num(0)}, {{0, 0.5}, {0, 0}}, 3);
  p.pinned = {std::nullopt, Rational(0)};
  p.events.push_back({arena_.Le(Num(1), x), {std::nullopt, Num(1)}});
  Always(p, arena_.Le(x, Num(1.001)));
  PartRecord record;
  record.steps.push_back({.length = 0.25, .degree = 1});
  PartRecord::Step cross{.length = 0.875, .degree = 1, .kind = PartRecord::Step::Kind::kCross};
  cross.together = 0.25;
  cross.time = {{{0}, 0.5}, {{1}, -0.25}};  // x = 0.5 + 0.25 s at 0.25: 1 is reached after 0.5 - 0.25 s
  record.steps.push_back(cross);
  record.steps.push_back({.length = 0.25, .degree = 1});
  const auto checked = [&] { return Checked(p, {{record}}).accepted; };
  EXPECT_TRUE(checked());
  Always(p, arena_.Le(x, Num(0.999)));
  EXPECT_FALSE(checked());
  Always(p, arena_.Le(Num(-0.5), x));  // from 1, at t = 0.5 at the earliest, it falls to -0.25
  EXPECT_TRUE(checked());
  Always(p, arena_.Le(Num(-0.2), x));
  EXPECT_FALSE(checked());
  Always(p, arena_.Le(x, Num(1.001)));
  // Of half of the tank, the record is about half of its symbol.
  const Certificate whole{{record}};
  Problem half = p;
  half.initial[0] = {0, 0.25};
  PartRecord own = record;
  own.path = {};
  EXPECT_FALSE(Checked(half, {{own}}).accepted);  // that is about its own symbol
  own.steps[1].time = {{{0}, 0.625}, {{1}, -0.125}};
  EXPECT_TRUE(Checked(half, {{own}}).accepted);
  record.steps[1].time[0].second = 0.75;  // too late
  EXPECT_FALSE(checked());
  record.steps[1].time[0].second = 0.5;
  record.steps[1].time[1].second = 0.25;
  EXPECT_FALSE(checked());
  record.steps[1].time[1].second = -0.25;
  record.steps[1].event = 1;
  EXPECT_FALSE(checked());
  record.steps[1].event = 0;
  record.steps[1].length = 0.5;  // before all have met it
  EXPECT_FALSE(checked());
  record.steps.erase(record.steps.begin() + 1);  // none at all
  EXPECT_FALSE(checked());
}

// Of several comparisons, all but one must be decided. What leads back at once leads nowhere.
TEST_F(Problems, WithAnEventMayHaveSeveralConditions) {
  const TermId x = Var("x"), y = Var("y"), tap = Var("tap");
  const TermId shut = arena_.Eq(tap, Num(1));
  Problem p =
      Make({x, y, tap}, {arena_.Ite(shut, Num(-0.5), Num(1)), Num(1), Num(0)}, {{0, 0.5}, {0, 0}, {0, 0}}, 3);
  p.pinned = {std::nullopt, Rational(0), Rational(0)};
  const auto when = [&](TermId condition, double to) {
    p.events.push_back({condition, {std::nullopt, std::nullopt, Num(to)}});
  };
  const TermId open = arena_.Eq(tap, Num(0));
  const TermId full = arena_.Le(Num(1), x);
  PartRecord record;
  PartRecord::Step cross{.length = 0.875, .degree = 1, .kind = PartRecord::Step::Kind::kCross};
  cross.together = 0.25;
  cross.time = {{{0}, 0.5}, {{1}, -0.25}};
  record.steps = {{.length = 0.25, .degree = 1}, cross, {.length = 0.25, .degree = 1}};
  const auto checked = [&](TermId condition, TermId back, TermId claim) {
    p.events.clear();
    when(arena_.And({open, condition}), 1);
    if (back.valid()) when(arena_.And({shut, back}), 0);
    Always(p, claim);
    return Checked(p, {{record}}).accepted;
  };
  const TermId below = arena_.Le(x, Num(1.001));
  const TermId none;
  EXPECT_TRUE(checked(full, none, below));
  EXPECT_TRUE(checked(arena_.And({full, arena_.Le(y, Num(2))}), none, below));
  EXPECT_TRUE(checked(arena_.Or(full, arena_.Le(Num(2), y)), none, below));
  EXPECT_FALSE(checked(arena_.And({full, arena_.Le(y, Num(0.7))}), none, below));  // not by all of them
  EXPECT_FALSE(checked(arena_.And({full, arena_.Le(Num(0.7), y)}), none, below));
  EXPECT_FALSE(checked(arena_.Or(full, arena_.Le(Num(0.7), y)), none, arena_.Le(Num(-1), y)));
  EXPECT_FALSE(checked(arena_.Or(full, arena_.Le(Num(2), y)), none, arena_.Le(x, Num(0.999))));
  const TermId early = arena_.Le(arena_.Add(x, y), Num(10));
  EXPECT_FALSE(checked(full, early, below));
  // x falls when the tap is shut, so that it opens again at once, and so on: the time is as unknown as
  // before.
  EXPECT_FALSE(checked(full, arena_.Lt(x, Num(1)), below));
  EXPECT_FALSE(checked(full, arena_.Le(x, Num(1)), below));
  p.rates[0] = arena_.Ite(shut, Num(0.5), Num(1));  // now it goes on rising
  EXPECT_TRUE(checked(full, arena_.Lt(x, Num(1)), arena_.Le(x, Num(2.251))));
  EXPECT_TRUE(checked(full, arena_.Le(x, Num(1)), arena_.Le(x, Num(2.251))));
  EXPECT_FALSE(checked(full, arena_.Le(x, Num(1)), arena_.Le(x, Num(2.249))));
  EXPECT_FALSE(checked(full, arena_.Le(x, Num(1.01)), arena_.Le(x, Num(2.251))));
}

// A parabola x = a - 2 t + t^2 with a in [0.9, 1.1] touches zero, or not: it is crossed twice or not at all.
// Meanwhile, all modes are possible.
TEST_F(Problems, WithATouchFollowAllModes) {
  const TermId x = Var("x"), y = Var("y"), inside = Var("inside"), count = Var("count");
  Problem p =
      Make({x, y, inside, count}, {y, Num(2), Num(0), Num(0)}, {{0.9, 1.1}, {-2, -2}, {0, 0}, {0, 0}}, 2);
  p.pinned = {std::nullopt, Rational(-2), Rational(0), Rational(0)};
  const auto when = [&](double from, TermId condition, double to) {
    p.events.push_back({arena_.And({arena_.Eq(inside, Num(from)), condition}),
                        {std::nullopt, std::nullopt, Num(to), arena_.Add(count, Num(1))}});
  };
  when(0, arena_.Le(x, Num(0)), 1);
  when(1, arena_.Lt(Num(0), x), 0);
  PartRecord::Step several{.length = 0.02, .degree = 2, .kind = PartRecord::Step::Kind::kSeveral};
  const auto finally = [&](TermId formula) {
    p.claims = {{"post", formula, p.horizon, p.horizon}};
    return Checked(p, {{{{}, {several}}}}).accepted;
  };
  EXPECT_TRUE(finally(arena_.Or(arena_.Eq(count, Num(0)), arena_.Eq(count, Num(2)))));
  EXPECT_TRUE(finally(arena_.Eq(inside, Num(0))));
  EXPECT_FALSE(finally(arena_.Eq(count, Num(0))));
  EXPECT_FALSE(finally(arena_.Eq(count, Num(2))));
  Always(p, arena_.Eq(inside, Num(0)));
  EXPECT_FALSE(Checked(p, {{{{}, {several}}}}).accepted);
  Always(p, arena_.Le(Num(-0.11), x));
  EXPECT_TRUE(Checked(p, {{{{}, {several}}}}).accepted);
  // Where it touches for certain, or not at all.
  p.initial[0] = {0.9, 0.95};
  EXPECT_TRUE(finally(arena_.Eq(count, Num(2))));
  p.initial[0] = {1.05, 1.1};
  EXPECT_TRUE(finally(arena_.Eq(count, Num(0))));
  // What is known of rates does not outlive the instant at which a controller changes them.
  p.initial[0] = {0.9, 1.1};
  const TermId u = Var("u");
  p.states.push_back(u);
  p.rates = {arena_.Add(u, y), Num(2), Num(0), Num(0), Num(0)};
  p.initial.push_back({0, 0});
  p.pinned.emplace_back(Rational(0));
  for (Event& e : p.events) e.updates.emplace_back();
  p.controller.emplace();
  p.controller->period = *Rational::Parse("1.5");
  p.controller->updates.resize(5);
  for (const double drop : {0.0, 10.0}) {
    p.controller->updates[4] = arena_.Ite(arena_.Le(Num(0), y), Num(-drop), Num(0));
    EXPECT_EQ(finally(arena_.Le(count, Num(2))), drop == 0) << drop;
  }
}

TEST_F(Problems, FollowNoEventsWithoutARecord) {
  const TermId x = Var("x"), inside = Var("inside");
  Problem p = Make({x, inside}, {Num(1), Num(0)}, {{-0.5, 0}, {0, 0}}, 1);
  p.pinned = {std::nullopt, Rational(0)};
  p.events.push_back(
      {arena_.And({arena_.Eq(inside, Num(0)), arena_.Le(Num(0.2), x)}), {std::nullopt, Num(1)}});
  Always(p, arena_.Le(x, Num(2)));
  EXPECT_FALSE(Checked(p, Even(0.02)).accepted);
}

// After a touch that may have happened, the modes go different ways: each is followed on its own.
TEST_F(Problems, WithBranchesFollowEach) {
  const TermId x = Var("x"), y = Var("y"), z = Var("z"), inside = Var("inside");
  const TermId rate = arena_.Ite(arena_.Eq(inside, Num(1)), Num(1), Num(0));
  Problem p = Make({x, y, z, inside}, {y, Num(2), rate, Num(0)}, {{0.9, 1.1}, {-2, -2}, {0, 0}, {0, 0}}, 2);
  p.pinned = {std::nullopt, Rational(-2), Rational(0), Rational(0)};
  p.events.push_back({arena_.And({arena_.Eq(inside, Num(0)), arena_.Le(x, Num(0))}),
                      {std::nullopt, std::nullopt, std::nullopt, Num(1)}});
  using Kind = PartRecord::Step::Kind;
  PartRecord record;
  for (int i = 0; i < 75; ++i) record.steps.push_back({.length = 0.02, .degree = 2, .kind = Kind::kSeveral});
  for (int branch = 0; branch < 2; ++branch) {
    record.steps.push_back({.kind = Kind::kSeveral});
    for (int i = 0; i < 25; ++i) record.steps.push_back({.length = 0.02, .degree = 2});
  }
  const auto finally = [&](TermId formula) {
    p.claims = {{"post", formula, p.horizon, p.horizon}};
    return Checked(p, {{record}}).accepted;
  };
  // It is met after 1 - sqrt(1 - a) seconds, from 0.68 to 1.
  EXPECT_TRUE(finally(arena_.Le(z, Num(1.4))));
  EXPECT_FALSE(finally(arena_.Le(z, Num(1.31))));
  // Until the branches part, z rises with any rate from 0 to 1.
  EXPECT_TRUE(finally(arena_.Or(arena_.Eq(inside, Num(1)), arena_.Le(z, Num(0.9)))));
  EXPECT_FALSE(finally(arena_.Eq(inside, Num(1))));
  EXPECT_FALSE(finally(arena_.Eq(inside, Num(0))));
}

}  // namespace
}  // namespace rondo::reach::certify
