// What `solve/solver.h` promises, asked of every engine that implements it.
#include "solve/solver.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <thread>

#include "expr/evaluate.h"
#include "solve/cache/caching_solver.h"
#include "solve/icp/icp_solver.h"
#include "solve/portfolio/portfolio.h"
#include "solve/smtlib/process.h"
#include "solve/smtlib/smtlib_solver.h"
#include "solve/z3/z3_solver.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::Elementary;
using expr::Rational;
using expr::TermId;

/// An engine with what it stands on.
struct Engine {
  std::vector<std::unique_ptr<Solver>> below;
  std::unique_ptr<cache::ProofCache> cache;
  std::unique_ptr<Solver> solver;
};

struct Kind {
  const char* name;
  std::function<Engine()> make;
};

std::filesystem::path Folder(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("rondo_conformance_" + std::to_string(getpid()) + name);
}

bool Runs(const std::string& program) {
  return smtlib::RunProcess({program, "--version"}, "", std::chrono::seconds(20), {}).ok();
}

template <typename T>
Engine Alone() {
  Engine e;
  e.solver = std::make_unique<T>();
  return e;
}

Engine Cvc5() {
  Engine e;
  if (Runs("cvc5")) e.solver = std::make_unique<smtlib::SmtLibSolver>("cvc5");
  return e;
}

Engine Threads() {
  Engine e;
  icp::Options options;
  options.jobs = 3;
  e.solver = std::make_unique<icp::IcpSolver>(options);
  return e;
}

Engine Caching() {
  Engine e;
  e.below.push_back(std::make_unique<icp::IcpSolver>());
  e.cache = std::make_unique<cache::ProofCache>(Folder("proofs"));
  e.solver = std::make_unique<cache::CachingSolver>(*e.below[0], *e.cache);
  return e;
}

Engine Portfolio(bool compare) {
  Engine e;
  e.below.push_back(std::make_unique<z3::Z3Solver>());
  portfolio::Options options;
  options.others = {e.below[0].get()};
  options.compare = compare;
  options.reproducer = Folder("disagreement.smt2");
  e.solver = std::make_unique<portfolio::PortfolioSolver>(options);
  return e;
}

Engine PortfolioOfOne() {
  Engine e;
  e.solver = std::make_unique<portfolio::PortfolioSolver>(portfolio::Options{});
  return e;
}

class Solvers : public testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    engine_ = GetParam().make();
    if (engine_.solver == nullptr) GTEST_SKIP() << "the program is not installed";
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(Folder("proofs"), ignored);
  }

  const Solver& solver() const { return *engine_.solver; }
  Answer Ask(std::vector<Assertion> assertions, const Budget& budget = {}) {
    const std::vector<TermId> wanted{x_, y_, n_, b_, c_};
    return solver().Check({&arena_, std::move(assertions), wanted}, budget, {});
  }
  Answer Ask(TermId formula) { return Ask({{formula, "all"}}); }

  TermId Constant(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Call(Elementary f, TermId a) { return arena_.Apply(f, {a}); }

  // Every valuation that an answer with exact values allows makes the formulas true, as far as it goes.
  void ExpectRight(const Answer& answer, const std::vector<Assertion>& assertions) {
    const auto* sat = std::get_if<Sat>(&answer);
    if (sat == nullptr || !sat->exact || !sat->near.empty()) return;
    const auto value = [&](TermId t) -> std::optional<expr::Value> {
      const auto it = sat->values.find(t);
      return it == sat->values.end() ? std::nullopt : std::optional(it->second);
    };
    for (const Assertion& a : assertions) {
      const auto truth = expr::Evaluate(arena_, a.formula, value);
      if (truth) {
        EXPECT_TRUE(truth->AsBool()) << ToSmtLib({&arena_, assertions, {}});
      }
    }
  }

  /// Formulas and whether they have a solution.
  std::vector<std::pair<TermId, bool>> Known();
  std::vector<std::pair<TermId, bool>> Roots();
  void ExpectNoContradiction(const std::vector<std::pair<TermId, bool>>& known) {
    for (const auto& [formula, solvable] : known) {
      const Answer answer = Ask(formula);
      EXPECT_FALSE(solvable ? std::holds_alternative<Unsat>(answer) : std::holds_alternative<Sat>(answer))
          << ToSmtLib({&arena_, {{formula, ""}}, {}});
    }
  }

  Engine engine_;
  Arena arena_;
  const expr::SortId colour_ = arena_.Enum("Colour", {"red", "green", "blue"});
  const TermId x_ = Constant("x", arena_.Real()), y_ = Constant("y", arena_.Real());
  const TermId n_ = Constant("n", arena_.Int()), b_ = Constant("b", arena_.Bool());
  const TermId c_ = Constant("c", colour_);
};

std::vector<std::pair<TermId, bool>> Solvers::Known() {
  Arena& a = arena_;
  const TermId zero = Number("0"), one = Number("1"), two = Number("2");
  const TermId xx = a.Mul(x_, x_), yy = a.Mul(y_, y_);
  const TermId small = a.And({a.Le(Number("-2"), x_), a.Le(x_, two), a.Le(Number("-2"), y_), a.Le(y_, two)});
  return {
      {a.And(a.Le(one, x_), a.Le(x_, one)), true},
      {a.And(a.Lt(x_, one), a.Le(one, x_)), false},
      {a.And(a.Eq(a.Add(x_, y_), one), a.Eq(a.Sub(x_, y_), Number("1/3"))), true},
      {a.And({a.Eq(a.Add(x_, y_), one), a.Lt(x_, Number("1/2")), a.Lt(y_, Number("1/2"))}), false},
      // The circle touches one line and misses the other.
      {a.And({small, a.Eq(a.Add(xx, yy), one), a.Eq(y_, one)}), true},
      {a.And({small, a.Eq(a.Add(xx, yy), one), a.Le(Number("3/2"), a.Add(x_, y_))}), false},
      {a.And(small, a.And(a.Eq(a.Mul(x_, y_), one), a.Lt(x_, zero))), true},
      {a.And(small, a.Lt(Number("8"), a.Add(xx, yy))), false},
      {a.Lt(xx, zero), false},
      {a.And({small, a.Or(a.Lt(x_, one), a.Lt(y_, one)), a.Le(one, x_), a.Le(one, y_)}), false},
      {a.And({small, a.Or(a.Lt(x_, one), a.Lt(y_, one)), a.Le(one, x_)}), true},
      // Between two integers there is none.
      {a.And(a.Lt(a.IntNumber(0), n_), a.Lt(n_, a.IntNumber(2))), true},
      {a.And({a.Lt(zero, a.ToReal(n_)), a.Lt(a.ToReal(n_), Number("0.9"))}), false},
      {a.And({a.Le(a.IntNumber(0), n_), a.Le(n_, a.IntNumber(9)),
              a.Eq(a.Mul(a.ToReal(n_), a.ToReal(n_)), Number("49"))}),
       true},
      {a.And({a.Le(a.IntNumber(0), n_), a.Le(n_, a.IntNumber(9)),
              a.Eq(a.Mul(a.ToReal(n_), a.ToReal(n_)), Number("50"))}),
       false},
      {a.And(b_, a.Not(b_)), false},
      {a.And(a.Or(b_, a.Lt(x_, zero)), a.And(a.Not(b_), a.Le(Number("-1"), x_))), true},
      {a.And({a.Not(a.Eq(c_, a.Member(colour_, 0))), a.Not(a.Eq(c_, a.Member(colour_, 2)))}), true},
      {a.And({a.Not(a.Eq(c_, a.Member(colour_, 0))), a.Not(a.Eq(c_, a.Member(colour_, 1))),
              a.Not(a.Eq(c_, a.Member(colour_, 2)))}),
       false},
      {a.Lt(a.Ite(b_, x_, a.Neg(x_)), zero), true},
      {a.And(a.Le(zero, x_), a.Lt(a.Ite(a.Lt(x_, zero), a.Neg(x_), x_), zero)), false},
      // Elementary functions.
      {a.And(small, a.Le(Number("2"), Call(Elementary::kSin, x_))), false},
      {a.And(small, a.Le(Number("1/2"), Call(Elementary::kSin, x_))), true},
      {a.And(small, a.Lt(a.Add(Call(Elementary::kCos, x_), one), Number("0.1"))), false},
      {a.And(small, a.Eq(Call(Elementary::kAbs, x_), one)), true},
  };
}

// Where a root has no value, no comparison with it holds.
std::vector<std::pair<TermId, bool>> Solvers::Roots() {
  Arena& a = arena_;
  const TermId zero = Number("0"), one = Number("1");
  const TermId small = a.And(a.Le(Number("-2"), x_), a.Le(x_, Number("2")));
  return {
      {a.And(small, a.Eq(Call(Elementary::kSqrt, x_), Number("1.5"))), false},
      {a.And(small, a.Eq(Call(Elementary::kSqrt, x_), Number("0.5"))), true},
      {a.And(a.Lt(x_, zero), a.Le(Call(Elementary::kSqrt, x_), one)), false},
      {a.And(a.Lt(x_, zero), a.Not(a.Eq(Call(Elementary::kSqrt, x_), one))), false},
  };
}

TEST_P(Solvers, NeverContradictWhatIsKnown) { ExpectNoContradiction(Known()); }

TEST_P(Solvers, RespectTheDomainOfRoots) { ExpectNoContradiction(Roots()); }

TEST_P(Solvers, DecideLinearQuestions) {
  const auto known = Known();
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(Ask(known[i].first).index(), known[i].second ? 1u : 0u) << "question " << i;
}

TEST_P(Solvers, GiveValuesThatSatisfyTheQuery) {
  for (const auto& [formula, solvable] : Known()) ExpectRight(Ask(formula), {{formula, ""}});
}

TEST_P(Solvers, NameOnlyGroupsThatAreUnsatisfiableByThemselves) {
  const std::vector<Assertion> all{{arena_.Lt(x_, Number("0")), "low"},
                                   {arena_.Lt(y_, Number("5")), "other"},
                                   {arena_.Lt(Number("1"), x_), "high"},
                                   {arena_.Le(Number("0"), y_), "other"}};
  const Answer answer = solver().Check({&arena_, all, {}}, {}, {});
  const auto* unsat = std::get_if<Unsat>(&answer);
  ASSERT_NE(unsat, nullptr);
  if (unsat->core.empty()) return;  // an engine that tells none
  const std::set<std::string> core(unsat->core.begin(), unsat->core.end());
  EXPECT_EQ(core.size(), unsat->core.size());
  EXPECT_TRUE(core.contains("low") && core.contains("high"));
  std::vector<Assertion> alone;
  for (const Assertion& a : all) {
    if (core.contains(a.group)) alone.push_back(a);
  }
  EXPECT_TRUE(std::holds_alternative<Unsat>(solver().Check({&arena_, alone, {}}, {}, {})));
}

TEST_P(Solvers, NameNoGroupWhereThereIsNone) {
  const Answer answer = Ask({{arena_.Lt(x_, Number("0")), ""}, {arena_.Lt(Number("0"), x_), ""}});
  const auto* unsat = std::get_if<Unsat>(&answer);
  ASSERT_NE(unsat, nullptr);
  EXPECT_TRUE(unsat->core.empty());
}

TEST_P(Solvers, CallTheEmptyQuerySatisfiable) {
  EXPECT_TRUE(std::holds_alternative<Sat>(solver().Check({&arena_, {}, {}}, {}, {})));
}

TEST_P(Solvers, CallFalseUnsatisfiable) {
  const Answer answer = solver().Check({&arena_, {{arena_.False(), "f"}}, {}}, {}, {});
  EXPECT_TRUE(std::holds_alternative<Unsat>(answer));
}

TEST_P(Solvers, AreNotMoreCertainWithLittleTime) {
  for (const auto& [formula, solvable] : Known()) {
    const std::vector<Assertion> assertions{{formula, ""}};
    const Answer answer = Ask(assertions, {std::chrono::milliseconds(0)});
    EXPECT_FALSE(solvable ? std::holds_alternative<Unsat>(answer) : std::holds_alternative<Sat>(answer))
        << ToSmtLib({&arena_, assertions, {}});
    ExpectRight(answer, assertions);
  }
}

TEST_P(Solvers, GiveTheCertificateThatIsAskedForEachTime) {
  const std::vector<Assertion> impossible{{arena_.Lt(arena_.Mul(x_, x_), Number("0")), "g"}};
  const Budget budget{std::chrono::seconds(10), true, true};
  const auto certificate = [&] {
    const Answer answer = solver().Check({&arena_, impossible, {}}, budget, {});
    const auto* unsat = std::get_if<Unsat>(&answer);
    return unsat != nullptr && !unsat->certificate.empty();
  };
  const bool first = certificate();
  EXPECT_EQ(first, certificate());
}

TEST_P(Solvers, DoNotKnowWhenTheyAreStoppedBefore) {
  const base::StopToken stop;
  stop.RequestStop();
  // Nothing that can be read off: a circle, a line, and a curve.
  const TermId question = arena_.And({Known()[5].first, arena_.Eq(n_, arena_.IntNumber(3))});
  const Answer answer = solver().Check({&arena_, {{question, ""}}, {}}, {}, stop);
  EXPECT_TRUE(std::holds_alternative<Unknown>(answer)) << answer.index();
}

TEST_P(Solvers, AnswerTheSameQuestionAlike) {
  for (const size_t i : {2u, 3u, 4u, 7u}) {
    const std::vector<Assertion> assertions{{Known()[i].first, "g"}};
    const Answer first = solver().Check({&arena_, assertions, {}}, {}, {});
    const Answer second = solver().Check({&arena_, assertions, {}}, {}, {});
    ASSERT_EQ(first.index(), second.index()) << i;
    const auto* unsat = std::get_if<Unsat>(&first);
    if (unsat == nullptr) continue;
    EXPECT_EQ(unsat->core, std::get<Unsat>(second).core);
  }
}

TEST_P(Solvers, MayBeSharedByThreads) {
  const auto known = Known();
  std::vector<int> wrong(3);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      for (size_t i = 0; i < 8; ++i) {
        const auto& [formula, solvable] = known[i];
        const Answer answer = solver().Check({&arena_, {{formula, "g"}}, {}}, {}, {});
        wrong[t] += solvable ? std::holds_alternative<Unsat>(answer) : std::holds_alternative<Sat>(answer);
      }
    });
  }
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(wrong, (std::vector<int>{0, 0, 0}));
}

TEST_P(Solvers, HaveANameThatStays) {
  EXPECT_FALSE(solver().name().empty());
  EXPECT_EQ(solver().name(), GetParam().make().solver->name());
}

TEST_P(Solvers, NeverContradictAboutFunctionsAndQuantifiers) {
  const expr::SymbolId f = arena_.Declare("f", {arena_.Int()}, arena_.Int());
  const TermId at = arena_.Apply(f, std::vector<TermId>{n_});
  const TermId i = arena_.FreshBound("i", arena_.Int());
  const TermId positive =
      arena_.Forall({i}, arena_.Lt(arena_.IntNumber(0), arena_.Apply(f, std::vector<TermId>{i})));
  const TermId negative = arena_.Lt(at, arena_.IntNumber(0));
  EXPECT_FALSE(std::holds_alternative<Sat>(Ask(arena_.And(positive, negative))));
  EXPECT_FALSE(std::holds_alternative<Unsat>(Ask(negative)));
}

INSTANTIATE_TEST_SUITE_P(Every, Solvers,
                         testing::Values(Kind{"Icp", Alone<icp::IcpSolver>}, Kind{"IcpThreads", Threads},
                                         Kind{"Z3", Alone<z3::Z3Solver>}, Kind{"Cvc5", Cvc5},
                                         Kind{"Caching", Caching}, Kind{"PortfolioOfOne", PortfolioOfOne},
                                         Kind{"Portfolio", [] { return Portfolio(false); }},
                                         Kind{"PortfolioCompares", [] { return Portfolio(true); }}),
                         [](const auto& chosen) { return chosen.param.name; });

TEST(SmtLibPrograms, ErrorsAreNotKnown) {
  Arena arena;
  const Query query{&arena, {{arena.False(), ""}}, {}};
  for (const char* command : {"", "rondo-no-such-program", "false", "echo nonsense"}) {
    const Answer answer = smtlib::SmtLibSolver(command).Check(query, {}, {});
    ASSERT_TRUE(std::holds_alternative<Unknown>(answer)) << command;
    EXPECT_FALSE(std::get<Unknown>(answer).reason.empty()) << command;
  }
}

}  // namespace
}  // namespace rondo::solve
