// Every operator at special points (signs, zeros, whole numbers as Real and Int, huge, tiny, branch cuts)
// through every engine: exact values, doubles, interval search, Z3, and the checker of refutations, each
// against MPFR and the definitions (docs/adr/0005 and 0017).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <functional>
#include <map>

#include "expr/elementary.h"
#include "expr/numeric.h"
#include "formulas.h"
#include "lang/smtlib/script.h"
#include "solve/icp/icp_solver.h"
#include "solve/z3/z3_solver.h"

namespace rondo::solve {
namespace {

using expr::Rational;

/// What the definition says of an operator at a point.
enum class Meaning : uint8_t {
  kValue,
  kNone,      ///< no value: a comparison is false
  kAnything,  ///< some number; of atan2, some angle
};

/// A number of 200 bits; results are within 2^-190 of the exact ones.
class Number {
 public:
  explicit Number(double value = 0) { mpfr_init2(n_, 200), mpfr_set_d(n_, value, MPFR_RNDN); }
  Number(const Number& other) : Number() { mpfr_set(n_, other.n_, MPFR_RNDN); }
  Number& operator=(const Number&) = delete;
  ~Number() { mpfr_clear(n_); }
  mpfr_t& get() { return n_; }
  double ToDouble() const { return mpfr_get_d(n_, MPFR_RNDN); }

 private:
  mpfr_t n_;
};

struct Operator {
  const char* name;
  size_t arity;
  bool polynomial;
  std::function<Meaning(double, double, Number&)> at;
};

Meaning Unary(int (*f)(mpfr_t, const mpfr_t, mpfr_rnd_t), double x, Number& out) {
  Number a(x);
  f(out.get(), a.get(), MPFR_RNDN);
  return Meaning::kValue;
}
Meaning Binary(int (*f)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t), double x, double y, Number& out) {
  Number a(x);
  Number b(y);
  f(out.get(), a.get(), b.get(), MPFR_RNDN);
  return Meaning::kValue;
}

Meaning Power(double x, double y, Number& out) {
  if (y != 0 && x == 0 && y < 0) return Meaning::kAnything;
  if (y != 0 && x < 0 && y != std::floor(y)) return Meaning::kAnything;
  return Binary(mpfr_pow, x, y, out);  // pow(x, 0) = 1, pow(0, y) = 0 for y > 0, whole exponents by sign
}

const std::vector<Operator>& Operators() {
  static const std::vector<Operator> kAll{
      {"sqrt", 1, false,
       [](double x, double, Number& r) { return x < 0 ? Meaning::kNone : Unary(mpfr_sqrt, x, r); }},
      {"abs", 1, true, [](double x, double, Number& r) { return Unary(mpfr_abs, x, r); }},
      {"sin", 1, false, [](double x, double, Number& r) { return Unary(mpfr_sin, x, r); }},
      {"cos", 1, false, [](double x, double, Number& r) { return Unary(mpfr_cos, x, r); }},
      {"tan", 1, false, [](double x, double, Number& r) { return Unary(mpfr_tan, x, r); }},
      {"arcsin", 1, false,
       [](double x, double, Number& r) {
         return std::fabs(x) > 1 ? Meaning::kNone : Unary(mpfr_asin, x, r);
       }},
      {"arccos", 1, false,
       [](double x, double, Number& r) {
         return std::fabs(x) > 1 ? Meaning::kNone : Unary(mpfr_acos, x, r);
       }},
      {"arctan", 1, false, [](double x, double, Number& r) { return Unary(mpfr_atan, x, r); }},
      {"exp", 1, false, [](double x, double, Number& r) { return Unary(mpfr_exp, x, r); }},
      {"log", 1, false,
       [](double x, double, Number& r) { return x <= 0 ? Meaning::kNone : Unary(mpfr_log, x, r); }},
      {"sinh", 1, false, [](double x, double, Number& r) { return Unary(mpfr_sinh, x, r); }},
      {"tanh", 1, false, [](double x, double, Number& r) { return Unary(mpfr_tanh, x, r); }},
      {"+", 2, true, [](double x, double y, Number& r) { return Binary(mpfr_add, x, y, r); }},
      {"-", 2, true, [](double x, double y, Number& r) { return Binary(mpfr_sub, x, y, r); }},
      {"*", 2, true, [](double x, double y, Number& r) { return Binary(mpfr_mul, x, y, r); }},
      {"/", 2, true,
       [](double x, double y, Number& r) { return y == 0 ? Meaning::kAnything : Binary(mpfr_div, x, y, r); }},
      {"min", 2, true, [](double x, double y, Number& r) { return Binary(mpfr_min, x, y, r); }},
      {"max", 2, true, [](double x, double y, Number& r) { return Binary(mpfr_max, x, y, r); }},
      {"arctan2", 2, false,
       [](double x, double y, Number& r) {
         return x == 0 && y == 0 ? Meaning::kAnything : Binary(mpfr_atan2, x, y, r);
       }},
      {"^", 2, true, Power},
  };
  return kAll;
}

std::string Text(double value) {
  const Rational r = Rational::FromDouble(std::fabs(value));
  const std::string size = fmt::format("(/ {}.0 {}.0)", r.Numerator(), r.Denominator());
  return std::signbit(value) && value != 0 ? fmt::format("(- {})", size) : size;
}

/// x, and y if there is one, have these values, as Int where `whole`; z is the result of the operator, and
/// `claim` is said of it.
std::string Script(const Operator& op, double x, double y, bool whole, const std::string& claim) {
  const auto sort = [&](double v) {
    return whole && v == std::floor(v) && std::fabs(v) < 1e6 ? "Int" : "Real";
  };
  std::string text = fmt::format("(declare-fun x () {})\n(declare-fun z () Real)\n", sort(x));
  const auto equals = [&](const char* name, double v) {
    const bool integer = std::string(sort(v)) == "Int";
    const std::string size = fmt::format("{}", std::fabs(v));
    const std::string number = !integer ? Text(v) : v < 0 ? fmt::format("(- {})", size) : size;
    return fmt::format("(assert (= {} {}))\n", name, number);
  };
  if (op.arity == 2) text += fmt::format("(declare-fun y () {})\n", sort(y));
  text += equals("x", x);
  if (op.arity == 2) text += equals("y", y);
  text += fmt::format("(assert (= z ({} x{})))\n", op.name, op.arity == 2 ? " y" : "");
  return text + fmt::format("(assert {})\n", claim);
}

std::string Where(const std::string& script) { return "\n" + script; }

/// The answers to a script: of interval arithmetic, with its certificate, and of Z3.
class Engines {
 public:
  struct Said {
    std::string icp;
    std::string z3;
  };

  // Z3 knows polynomials and little more; asking it takes a while.
  Said Ask(const std::string& text, bool for_z3) {
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    lang::smtlib::Script script;
    lang::smtlib::ReadScript(sources, sources.Add("test", text), script, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << Where(text);
    Query query{&script.arena, {}, {}};
    for (const auto& c : script.commands) {
      if (c.kind == lang::smtlib::Command::Kind::kAssert) query.assertions.push_back({c.terms[0], ""});
    }
    icp::Options options;
    options.max_boxes = 5'000;
    const Answer answer =
        icp::IcpSolver(options).Check(query, {std::chrono::milliseconds(2000), false, true}, {});
    if (const auto* unsat = std::get_if<Unsat>(&answer)) {
      EXPECT_EQ(testing_support::Rejected(unsat->certificate), "") << Where(text);
      ++certified;
    }
    Said said{testing_support::Say(answer), ""};
    if (!for_z3) return said;
    said.z3 = testing_support::Say(z3_.Check(query, {std::chrono::milliseconds(500), false, false}, {}));
    return said;
  }

  size_t certified = 0;

 private:
  z3::Z3Solver z3_;
};

void Examine(const Operator& op, double x, double y, bool whole, Engines& engines) {
  Number exact;
  const Meaning meaning = op.at(x, y, exact);
  const double value = exact.ToDouble();
  const auto never = [&](const std::string& answer, const std::string& claim) {
    const std::string script = Script(op, x, y, whole, claim);
    const Engines::Said said = engines.Ask(script, op.polynomial);
    EXPECT_NE(said.icp, answer) << Where(script);
    EXPECT_NE(said.z3, answer) << Where(script);
  };
  switch (meaning) {
    case Meaning::kNone:
      // Neither the atom nor its negation holds where there is no value.
      never("sat", "(< z 3.0)");
      never("sat", "(>= z 3.0)");
      return;
    case Meaning::kAnything:
      never("unsat", "(= z 3.0)");
      never("unsat", "(< z (- 0.5))");
      if (std::string(op.name) != "arctan2") never("unsat", "(= z 12345.0)");
      return;
    case Meaning::kValue:
      break;
  }
  if (!(std::fabs(value) < 1e300)) return;  // beyond doubles
  const double room = std::fmax(std::fabs(value) * 1e-9, 1e-12);
  const std::string low = Text(value - room);
  const std::string high = Text(value + room);
  never("unsat", fmt::format("(and (<= {} z) (<= z {}))", low, high));
  never("sat", fmt::format("(> z {})", high));
  never("sat", fmt::format("(< z {})", low));
  // The checker has values of its own: no box is empty in which the value lies.
  const std::string good = Script(op, x, y, whole, fmt::format("(and (<= {} z) (<= z {}))", low, high));
  std::string facts = good;
  for (size_t at = 0; (at = good.find("(assert ", at)) != std::string::npos; ++at) {
    const size_t end = good.find('\n', at);
    facts += "(fact " + good.substr(at + 8, end - at - 9) + ")\n";
  }
  const std::string variables = op.arity == 2 ? "x y z" : "x z";
  EXPECT_NE(testing_support::Rejected(facts + fmt::format("(search ({}) \".\")\n", variables)), "")
      << Where(facts);
  EXPECT_NE(testing_support::Rejected(good + "(contradiction)\n"), "") << Where(good);
}

// What is known exactly, and what doubles make of it.
void Compare(const Operator& op, double x, double y) {
  static const std::map<std::string, expr::Elementary> kNamed{
      {"sqrt", expr::Elementary::kSqrt},     {"abs", expr::Elementary::kAbs},
      {"sin", expr::Elementary::kSin},       {"cos", expr::Elementary::kCos},
      {"tan", expr::Elementary::kTan},       {"arcsin", expr::Elementary::kAsin},
      {"arccos", expr::Elementary::kAcos},   {"arctan", expr::Elementary::kAtan},
      {"exp", expr::Elementary::kExp},       {"log", expr::Elementary::kLog},
      {"min", expr::Elementary::kMin},       {"max", expr::Elementary::kMax},
      {"arctan2", expr::Elementary::kAtan2}, {"^", expr::Elementary::kPower}};
  const auto function = kNamed.find(op.name);
  if (function == kNamed.end()) return;
  Number exact;
  const Meaning meaning = op.at(x, y, exact);
  std::vector<Rational> args{Rational::FromDouble(x)};
  if (op.arity == 2) args.push_back(Rational::FromDouble(y));
  const auto known = expr::ExactValue(function->second, args);
  if (known) {
    ASSERT_EQ(meaning, Meaning::kValue) << op.name << " " << x << " " << y;
    const double value = exact.ToDouble();
    if (std::isfinite(value)) {
      EXPECT_NEAR(known->ToDouble(), value, std::fabs(value) * 1e-15) << op.name << " " << x;
    }
  }
  expr::Arena arena;
  std::vector<expr::TermId> terms;
  for (size_t i = 0; i < args.size(); ++i) terms.push_back(arena.FreshConstant("v", arena.Real()));
  expr::Numeric::Point point{{terms[0], x}};
  if (op.arity == 2) point[terms[1]] = y;
  const double near = expr::Numeric(arena, point)(arena.Apply(function->second, terms));
  if (meaning == Meaning::kValue && std::fabs(exact.ToDouble()) < 1e300) {
    const double room = std::fmax(std::fabs(exact.ToDouble()) * 1e-12, 1e-300);
    EXPECT_NEAR(near, exact.ToDouble(), room) << op.name << " " << x;
  }
  if (meaning == Meaning::kNone) {
    EXPECT_TRUE(std::isnan(near)) << op.name << " " << x;
  }
}

class Points : public testing::TestWithParam<size_t> {};

TEST_P(Points, AreWhatTheDefinitionSays) {
  const Operator& op = Operators()[GetParam()];
  Engines engines;
  if (op.arity == 1) {
    for (const double x : {-1e300,
                           -1e9,
                           -65537.0,
                           -100.0,
                           -3.0,
                           -2.0,
                           -1.5,
                           -1.0,
                           -0.5,
                           -1e-9,
                           -1e-300,
                           0.0,
                           1e-300,
                           1e-9,
                           0.5,
                           1.0,
                           1.5707963267948966,
                           2.0,
                           3.0,
                           3.141592653589793,
                           4.0,
                           100.0,
                           65537.0,
                           1e9,
                           1e300}) {
      Compare(op, x, 0);
      Examine(op, x, 0, false, engines);
      if (x == std::floor(x) && std::fabs(x) < 4) Examine(op, x, 0, true, engines);
    }
  } else {
    for (const double x : {-1e10, -2.0, -0.5, 0.0, 0.5, 1.0, 3.0}) {
      for (const double y : {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 3.0, 70.0}) {
        Compare(op, x, y);
        Examine(op, x, y, false, engines);
        if (x == std::floor(x) && y == std::floor(y) && std::fabs(x) < 4) Examine(op, x, y, true, engines);
      }
    }
  }
  EXPECT_GT(engines.certified, 10U) << "hardly anything was refuted";
}

std::string NameOf(const testing::TestParamInfo<size_t>& point) {
  static const std::map<std::string, std::string> kSigns{
      {"+", "plus"}, {"-", "minus"}, {"*", "times"}, {"/", "quotient"}, {"^", "power"}};
  const std::string name = Operators()[point.param].name;
  const auto it = kSigns.find(name);
  return it == kSigns.end() ? name : it->second;
}

INSTANTIATE_TEST_SUITE_P(AllOperators, Points, testing::Range<size_t>(0, 20), NameOf);

}  // namespace
}  // namespace rondo::solve
