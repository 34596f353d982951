// The interval solver against others: random formulas against Z3 and against sampling, every back end, any
// number of threads, scaled and permuted copies; and questions that other solvers once answered wrongly.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "expr/evaluate.h"
#include "formulas.h"
#include "lang/smtlib/script.h"
#include "solve/icp/icp_solver.h"
#include "solve/z3/z3_solver.h"

namespace rondo::solve::icp {
namespace {

using expr::Arena;
using expr::Elementary;
using expr::Rational;
using expr::TermId;
using testing_support::CertificateProblem;
using testing_support::Formulas;
using testing_support::Say;

// Plain floating point, written for this test: does the point satisfy the formula, and by which margin?
// Undefined terms are NaN, and no comparison with them holds.
class Sampler {
 public:
  Sampler(const Arena& arena, const std::vector<TermId>& variables, std::vector<double> point)
      : arena_(arena), variables_(variables), point_(std::move(point)) {}

  // What is undefined, or decided by it, is neither clearly true nor clearly false.
  static constexpr double kNoClaim = -1e-9;

  // Positive: true with that margin.
  double Margin(TermId f, bool positive) {
    const auto arg = [&](size_t i) { return arena_.arg(f, i); };
    switch (arena_.op(f)) {
      case expr::Op::kBool:
        return (f == arena_.True()) == positive ? 1 : -1;
      case expr::Op::kNot:
        return Margin(arg(0), !positive);
      case expr::Op::kAnd:
      case expr::Op::kOr: {
        const bool all = (arena_.op(f) == expr::Op::kAnd) == positive;
        double best = all ? 1e300 : -1e300;
        for (const TermId a : arena_.args(f))
          best = all ? std::min(best, Margin(a, positive)) : std::max(best, Margin(a, positive));
        return best;
      }
      case expr::Op::kEq: {
        const double d = std::fabs(Value(arg(0)) - Value(arg(1)));
        if (std::isnan(d)) return kNoClaim;
        return positive ? -1 : d;
      }
      default: {
        const double d = Value(arg(1)) - Value(arg(0));
        if (std::isnan(d)) return kNoClaim;
        return positive ? d : -d;
      }
    }
  }

 private:
  double Value(TermId t) {
    const auto arg = [&](size_t i) { return Value(arena_.arg(t, i)); };
    switch (arena_.op(t)) {
      case expr::Op::kNumber:
        return arena_.number(t).ToDouble();
      case expr::Op::kVariable:
        for (size_t v = 0; v < variables_.size(); ++v) {
          if (variables_[v] == t) return point_[v];
        }
        return NAN;
      case expr::Op::kAdd: {
        double sum = 0;
        for (size_t i = 0; i < arena_.args(t).size(); ++i) sum += arg(i);
        return sum;
      }
      case expr::Op::kMul:
        return arg(0) * arg(1);
      case expr::Op::kDivide:
        return arg(1) == 0 ? NAN : arg(0) / arg(1);
      case expr::Op::kIte: {
        const double margin = Margin(arena_.arg(t, 0), true);
        // Near the border rounding decides: no claim is made there.
        if (std::fabs(margin) < 1e-6) return NAN;
        return arg(margin > 0 ? 1 : 2);
      }
      default:
        break;
    }
    const double a = arg(0);
    switch (arena_.elementary_of(t)) {
      case Elementary::kSqrt:
        return a < 0 ? NAN : std::sqrt(a);
      case Elementary::kAbs:
        return std::fabs(a);
      case Elementary::kMin:
        return std::min(a, arg(1));
      case Elementary::kMax:
        return std::max(a, arg(1));
      case Elementary::kSin:
        return std::sin(a);
      case Elementary::kCos:
        return std::cos(a);
      case Elementary::kTan:
        return std::tan(a);
      case Elementary::kAsin:
        return std::asin(a);
      case Elementary::kAcos:
        return std::acos(a);
      case Elementary::kAtan:
        return std::atan(a);
      case Elementary::kAtan2:
        return std::atan2(a, arg(1));
      case Elementary::kExp:
        return std::exp(a);
      case Elementary::kLog:
        return a <= 0 ? NAN : std::log(a);
      case Elementary::kPower:
        return a == 0 && arg(1) < 0 ? NAN : std::pow(a, arg(1));
      case Elementary::kCount_:
        break;
    }
    return NAN;
  }

  const Arena& arena_;
  const std::vector<TermId>& variables_;
  std::vector<double> point_;
};

double BestMargin(Formulas& formulas, uint64_t seed, int samples) {
  std::mt19937_64 rng(seed);
  double best = -1e300;
  for (int i = 0; i < samples; ++i) {
    std::vector<double> point;
    for (size_t v = 0; v < formulas.variables().size(); ++v) {
      const double u = static_cast<double>(rng() >> 11) * 0x1p-53;
      point.push_back(i % 3 == 0 ? std::round(u * 40 - 20) / 10 : u * 4 - 2);
    }
    Sampler sampler(formulas.arena(), formulas.variables(), point);
    double margin = 1e300;
    for (const Assertion& a : formulas.query().assertions)
      margin = std::min(margin, sampler.Margin(a.formula, true));
    best = std::max(best, margin);
  }
  return best;
}

// Every `unsat` below comes with a certificate.
const Budget kBudget{std::chrono::milliseconds(1000), false, true};

Options Few() {
  Options options;
  options.max_boxes = 20'000;
  options.boxes_before_links = 0;  // sums are tied to frames wherever there are any
  return options;
}

int Rounds() {
  const char* text = std::getenv("RONDO_CASES");
  return text == nullptr ? 400 : std::max(400, static_cast<int>(std::strtol(text, nullptr, 10) / 50));
}

TEST(Icp, AgreesWithZ3OnPolynomials) {
  const z3::Z3Solver z3;
  int decided = 0;
  for (int seed = 0; seed < Rounds(); ++seed) {
    Formulas f(static_cast<uint64_t>(seed), true);
    const Answer mine = IcpSolver(Few()).Check(f.query(), kBudget, {});
    const Answer other = z3.Check(f.query(), {std::chrono::milliseconds(300), false}, {});
    if (Say(mine) == "delta-sat" || Say(mine) == "unknown" || Say(other) == "unknown") continue;
    ++decided;
    ASSERT_EQ(CertificateProblem(mine), "") << "seed " << seed << "\n" << ToSmtLib(f.query());
    ASSERT_EQ(Say(mine), Say(other)) << "seed " << seed << "\n" << ToSmtLib(f.query());
  }
  EXPECT_GT(decided, Rounds() * 6 / 10);
}

TEST(Icp, NeverExcludesWhatSamplingFinds) {
  int unsat = 0;
  int sat = 0;
  for (int seed = 1000; seed < 1000 + 2 * Rounds(); ++seed) {
    Formulas f(static_cast<uint64_t>(seed), false);
    const Answer mine = IcpSolver(Few()).Check(f.query(), kBudget, {});
    sat += Say(mine) == "sat" ? 1 : 0;
    if (Say(mine) != "unsat") continue;
    ++unsat;
    ASSERT_EQ(CertificateProblem(mine), "") << "seed " << seed << "\n" << ToSmtLib(f.query());
    ASSERT_LT(BestMargin(f, static_cast<uint64_t>(seed), 2000), 1e-7) << "seed " << seed << "\n"
                                                                      << ToSmtLib(f.query());
  }
  EXPECT_GT(unsat, Rounds() / 10);
  EXPECT_GT(sat, Rounds() / 4);
}

// What is called a solution satisfies the formula in plain floating point, up to rounding.
TEST(Icp, SolutionsAreSolutions) {
  for (int seed = 5000; seed < 5000 + Rounds(); ++seed) {
    Formulas f(static_cast<uint64_t>(seed), false);
    const Answer mine = IcpSolver(Few()).Check(f.query(), kBudget, {});
    if (Say(mine) != "sat") continue;
    std::vector<double> point;
    bool complete = true;
    for (const TermId v : f.variables()) {
      const auto& values = std::get<Sat>(mine).values;
      const auto it = values.find(v);
      complete = complete && it != values.end();
      point.push_back(it == values.end() ? 0 : it->second.AsNumber().ToDouble());
    }
    if (!complete) continue;
    Sampler sampler(f.arena(), f.variables(), point);
    for (const Assertion& a : f.query().assertions) {
      const double negated = sampler.Margin(a.formula, false);
      ASSERT_LT(negated, 1e-7) << "seed " << seed << " at " << point[0] << " " << point[1] << " " << point[2]
                               << "\n"
                               << ToSmtLib(f.query());
    }
  }
}

TEST(Icp, BackEndsAndThreadsDoNotChangeVerdicts) {
  for (int seed = 9000; seed < 9000 + Rounds() / 4; ++seed) {
    Formulas f(static_cast<uint64_t>(seed), false);
    std::string first;
    for (const interval::Backend backend : interval::AvailableBackends()) {
      for (const unsigned jobs : {1u, 3u}) {
        Options options = Few();
        options.kernels = &interval::KernelsOf(backend);
        options.jobs = jobs;
        const std::string said = Say(IcpSolver(options).Check(f.query(), kBudget, {}));
        // Budgets may run out elsewhere; definite answers may not differ.
        if (said != "sat" && said != "unsat") continue;
        if (first.empty()) first = said;
        ASSERT_EQ(said, first) << "seed " << seed << " " << options.kernels->name << " " << jobs;
      }
    }
  }
}

std::string Solve(const std::string& text) {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  lang::smtlib::Script script;
  lang::smtlib::ReadScript(sources, sources.Add("test", text), script, diagnostics);
  if (diagnostics.has_errors()) return diagnostics.all()[0].message;
  Query query{&script.arena, {}, {}};
  for (const auto& c : script.commands) {
    if (c.kind == lang::smtlib::Command::Kind::kAssert) query.assertions.push_back({c.terms[0], ""});
  }
  const Answer answer = IcpSolver().Check(query, {std::chrono::milliseconds(20'000), false, true}, {});
  const std::string problem = CertificateProblem(answer);
  return problem.empty() ? Say(answer) : problem;
}

const std::string kReals = "(declare-fun x () Real)(declare-fun y () Real)(declare-fun z () Real)";

struct Known {
  const char* what;
  const char* script;
  const char* answer;
};

class KnownAnswers : public testing::TestWithParam<Known> {};

TEST_P(KnownAnswers, Hold) {
  EXPECT_EQ(Solve(kReals + GetParam().script), GetParam().answer) << GetParam().what;
}

// Questions that other solvers were reported to answer wrongly, with the report.
INSTANTIATE_TEST_SUITE_P(
    Reported, KnownAnswers,
    testing::Values(
        Known{"dreal3 #4: a cart and its pole at rest",
              "(declare-fun u () Real)(declare-fun w () Real)(assert (<= -10 x 10))(assert (<= -4 y 4))"
              "(assert (<= -10 w 10))(assert (<= -10 u 10))(assert (= w 0))(assert (= x 0))"
              "(assert (= (/ (+ (* (sin y) (^ w 2)) (* 9.8 (cos y) (sin y)) u) (+ (^ (sin y) 2) 2)) 0))"
              "(assert (= (/ (+ (* (sin y) (cos y) (^ w 2)) (* 3 9.8 (sin y)) (* (cos y) u))"
              " (- (+ (^ (sin y) 2) 2))) 0))",
              "sat"},
        Known{"dreal3 #12: not above",
              "(assert (<= 0.3999996185302735 x 0.39999985694885254))(assert (not (> (+ (* (- 1 0) x) 0) "
              "0.4)))",
              "sat"},
        Known{"dreal3 #12: above",
              "(assert (<= 0.3999996185302735 x 0.39999985694885254))(assert (> (+ (* (- 1 0) x) 0) 0.4))",
              "unsat"},
        Known{"dreal3 #49: a product of three",
              "(assert (<= -10000 x 10000))(assert (<= -10000 y 10000))"
              "(assert (<= 0 (+ (* (- 1) 0.9999999999999567 x) (* (- 120) 0.999999999999935 y))))",
              "sat"},
        Known{"dreal3 #129: the quotient is above 1, so nothing holds of its arc sine",
              "(assert (<= 0.53125000001 x 0.5625))(assert (<= 0.501 y 0.53125))"
              "(assert (> (asin (/ (+ (* 4 x) -2) (+ (* 4 y) -2))) 0.15915494309190006))",
              "unsat"},
        Known{"dreal3 #129: its negation, where the other part fails",
              "(assert (<= 0.5312500000000001 x 0.5625))(assert (<= 0.5000000000000001 y 0.53125))"
              "(assert (not (and (<= (abs (- (+ (^ (- (* 4 x) 2) 2) (^ (- (* 4 y) 2) 2)) 0.1)) 0.0001)"
              "(> (asin (/ (+ (* 4 x) -2) (+ (* 4 y) -2))) 0.15915494309190006))))",
              "sat"},
        Known{"dreal2 #54: a sum of powers",
              "(assert (< -2 x 2))(assert (< -2 y 2))(assert (< (+ (^ x 2) (^ y 3)) 0))", "sat"},
        Known{"dreal4 #258: atan2 of anything", "(assert (= z (atan2 3 y)))", "sat"},
        Known{"dreal4 #305: integers that differ",
              "(declare-fun i () Int)(declare-fun j () Int)(assert (<= 0 i))(assert (< i 1))(assert (<= 0 j))"
              "(assert (< j 1))(assert (not (= i j)))",
              "unsat"},
        Known{"z3 #5161",
              "(assert (>= (* x x) 0))(assert (> 0 (* x (- 1 x))))(assert (> 0 (- (ite (= x 0) 0 1))))"
              "(assert (> 0 (+ x (* y (- y)))))(assert (>= x 0))",
              "sat"},
        Known{"z3 #6130",
              "(declare-fun a () Real)(declare-fun b () Real)(declare-fun c () Real)(declare-fun d () Real)"
              "(assert (= 0 (+ (* x y) (* a z x) (* z x b) (* x b (- 1)) (* z x y (- 1)))))"
              "(assert (= 0 (+ c (* x y) (* a z x) (* z x b) (* x b (- 1)) (* c y (- 1)) (* z x y (- 1)) (* "
              "c d y "
              "(- 1)))))"
              "(assert (and (< 0 (* x x)) (> z 0) (> c 0)))(assert (= d (+ c 1.0)))",
              "sat"},
        Known{"z3 #6947", "(assert (< x 0))(assert (= (* x x) 2))", "sat"},
        Known{"z3 #7114",
              "(assert (< 0 x))(assert (= (- y) (* x (+ x y))))(assert (= 1 (+ (* x x) (* y y))))", "sat"},
        Known{"z3 #9139: a quotient of equals",
              "(declare-fun k () Int)"
              "(assert (= (to_real k) (- (/ (/ (+ 3 x) (+ (- (- 3)) 2)) (/ (+ 3 x) (+ (- (- 3)) 2))) x)))"
              "(assert (< -2 x))",
              "sat"},
        Known{"cvc5 #5726: high powers near 0",
              "(assert (not (<= (* y y y y y y) 0)))(assert (<= -1 x 1))(assert (<= -1 y 1))"
              "(assert (not (<= (* x (* x (- x (+ x (* x x (+ (* y (- y (/ 1 720))) (* x x))))))) 0)))",
              "sat"},
        Known{"cvc5 #8638",
              "(declare-fun a () Real)(declare-fun b () Real)(declare-fun c () Real)(assert (< 13 c 19))"
              "(assert (< -11 a))(assert (< a (/ (+ y z (- b)) c)))(assert (< 16 b 48))(assert (> (* y y y y "
              "b) 0))"
              "(assert (> (* y (+ 1 (* z (/ (- 1) 2)) (* y y z (/ 1 6)))) 0))(assert (> z (/ 15707963 "
              "5000000)))"
              "(assert (> (/ 31415927 10000000) z))(assert (> (* z (/ 1 2)) y))(assert (> x 0))(assert (> y "
              "x))",
              "sat"}),
    [](const auto& chosen) { return "Case" + std::to_string(chosen.index); });

INSTANTIATE_TEST_SUITE_P(
    All, KnownAnswers,
    testing::Values(
        Known{"complementary half-spaces", "(assert (< x 0.1))(assert (>= x 0.1))", "unsat"},
        Known{"complementary half-spaces of a term",
              "(assert (< (sin x) 0.1))(assert (>= (sin x) 0.1))(assert (<= 0 x 1))", "unsat"},
        Known{"strict on both sides",
              "(assert (< (* x y) 0.3))(assert (> (* x y) 0.3))(assert (<= 0 x 1))(assert (<= 0 y 1))",
              "unsat"},
        Known{"complementary inside a disjunction",
              "(assert (<= 0 x 1))(assert (<= 0 y 1))(assert (or (< (* x y) 0.3) (< x -1)))(assert (>= (* x "
              "y) 0.3))",
              "unsat"},
        Known{"a point that only exact arithmetic finds",
              "(assert (= (+ x (* 3 y)) 0.1))(assert (= (- x y) 0.7))", "sat"},
        Known{"a vanishing distance",
              "(assert (= (^ (+ (^ y 2) (^ (+ x -0.3) 2)) (/ 1 2)) 0))(assert (<= x 0.3))", "sat"},
        Known{"a vanishing distance elsewhere",
              "(assert (= (^ (+ (^ y 2) (^ (+ x -0.3) 2)) 0.5) 0))(assert (< x 0.3))", "unsat"},
        Known{"squares in disguise", "(assert (= (+ 0.5 (* x x) (* y y) y (- x)) 0))(assert (> x 0))", "sat"},
        Known{"the circle identity, as the papers on delta-decisions warn",
              "(assert (<= 0 x 3))(assert (> (+ (^ (sin x) 2) (^ (cos x) 2)) 1.0001))", "unsat"},
        Known{"a root is not negative", "(assert (<= -1 x 4))(assert (< (sqrt x) 0))", "unsat"},
        Known{"outside the domain nothing holds",
              "(assert (< x -1))(assert (or (<= (sqrt x) 1) (> (sqrt x) 1)))", "unsat"},
        Known{"an undefined alternative does not exclude the other",
              "(assert (<= -2 x -1))(assert (or (<= (sqrt x) 1) (<= x -1.5)))", "sat"},
        Known{"an equation about an undefined term", "(assert (= x (sqrt y)))(assert (<= -3 y -1))", "unsat"},
        Known{"an undefined product",
              "(assert (= z (+ x (* 2 (log y)))))(assert (<= -3 y -1))(assert (<= 0 x 1))", "unsat"},
        Known{"the logarithm below 0", "(assert (<= (log x) 5))(assert (<= -3 x -2))", "unsat"},
        Known{"numbers that differ only at the end",
              "(assert (< x 0.1000000000000000000000001))(assert (> x 0.1))", "sat"},
        Known{"the sine far out", "(assert (<= 1000000 x 1000001))(assert (> (sin x) 1.01))", "unsat"},
        Known{"a root of roots",
              "(assert (<= (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt "
              "(sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt (sqrt "
              "(sqrt (sqrt "
              "(sqrt (sqrt (sqrt x)))))))))))))))))))))))))))))))) 3))",
              "sat"},
        Known{"two equations that no rational numbers satisfy",
              "(assert (= (+ (* x x) (* y y)) 2))(assert (= (* x y) 0.7))(assert (> x y))", "sat"},
        Known{
            "three equations with a sine",
            "(assert (= (+ x y z) 1))(assert (= (sin x) (* y y)))(assert (= (* x z) 0.1))(assert (<= 0 x 2))",
            "sat"},
        Known{"empty bounds", "(assert (<= 2 x 1))", "unsat"},
        Known{"a chain of minima",
              "(assert (<= 0 x 1))(assert (<= 0 y 1))(assert (> (min x (max y x)) (+ x 0.01)))", "unsat"},
        Known{"if then else", "(assert (<= -1 x 1))(assert (< (ite (>= x 0) x (- x)) -0.01))", "unsat"},
        Known{"if then else, possible", "(assert (<= -1 x 1))(assert (< (ite (>= x 0) (- x) x) -0.5))",
              "sat"},
        Known{"an angle and its tangent", "(assert (<= 0.1 x 1.4))(assert (< (tan x) x))", "unsat"},
        Known{"atan2 in the second quadrant",
              "(assert (<= 1 y 2))(assert (<= -2 x -1))(assert (< (atan2 y x) 1.57))", "unsat"},
        Known{"a product of two scales",
              "(assert (<= 0 x 1))(assert (<= 0 y 1))(assert (> (* 3 (* x (* 5 y))) 15.1))", "unsat"},
        Known{"a product of two scales, possible",
              "(assert (<= 0 x 1))(assert (<= 0 y 1))(assert (> (* 3 (* x (* 5 (sin y)))) 12))", "sat"},
        Known{"constants stay constant from box to box",
              "(assert (<= -10 x 10))(assert (<= -10 y 10))(assert (>= (* x x) 1))(assert (<= (* 2 (* x x)) "
              "60))"
              "(assert (= (* x y) 7))(assert (>= (* 3 (+ x y)) 23))",
              "sat"}),
    [](const auto& chosen) { return "Case" + std::to_string(chosen.index); });

TEST(Icp, IntegersAndTruthValues) {
  const std::string head =
      "(declare-fun i () Int)(declare-fun j () Int)(declare-fun b () Bool)(declare-fun x () Real)";
  const auto solve = [&](const std::string& text) { return Solve(head + text); };
  EXPECT_EQ(solve("(assert (< 1 i 2))"), "unsat");
  EXPECT_EQ(solve("(assert (<= 0 i 10))(assert (<= 0 j 10))(assert (= (* i j) 21))(assert (> i j))"), "sat");
  EXPECT_EQ(solve("(assert (<= 2 i 10))(assert (<= 2 j 10))(assert (= (* i j) 13))"), "unsat");
  EXPECT_EQ(solve("(assert (xor b (<= x 1)))(assert b)(assert (<= 0 x 1))"), "unsat");
  EXPECT_EQ(solve("(assert (= b (<= x 1)))(assert b)(assert (<= 0 x 3))"), "sat");
  EXPECT_EQ(solve("(assert (<= 0 i 3))(assert (= x (* 0.5 (to_real i))))(assert (> x 1.5))"), "unsat");
}

// Two discs of which one is turned and moved: where they stand does not matter, how far apart they are does.
TEST(Icp, MovedScenesHaveTheSameAnswer) {
  for (const double dx : {0.0, 3.5, -7.25}) {
    for (const double gap : {0.02, 0.2, -0.05}) {
      const std::string text = fmt::format(
          "(declare-fun a () Real)(assert (<= 0 a 6.3))"
          "(assert (<= (+ (^ (- x {0}) 2) (^ y 2)) 0.25))"
          "(assert (<= (+ (^ (- x (+ {0} (* {1} (cos a)))) 2) (^ (- y (* {1} (sin a))) 2)) 0.25))",
          dx, 1 + gap);
      EXPECT_EQ(Solve(kReals + text), gap > 0 ? "unsat" : "sat") << dx << " " << gap;
    }
  }
}

}  // namespace
}  // namespace rondo::solve::icp
