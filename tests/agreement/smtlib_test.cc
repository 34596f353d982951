// The printed script means what the terms mean: an external solver reads it and agrees with Z3 in this
// process.
#include "expr/smtlib/smtlib.h"

#include <gtest/gtest.h>

#include "solve/smtlib/smtlib_solver.h"
#include "solve/z3/z3_solver.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::TermId;

TEST(SmtLib, AnExternalSolverAgrees) {
  Arena a;
  const expr::SortId colour = a.Enum("Colour", {"red", "light green"});
  const expr::SortId pos = a.Record("pos", {"x", "y"}, {a.Real(), a.Real()});
  const expr::SortId cells = a.Array(a.Int(), pos);
  const TermId v = a.Variable(a.Declare("Motion.psn'", {}, cells));
  const TermId i = a.Variable(a.Declare("some i!1", {}, a.Int()));
  const TermId c = a.Variable(a.Declare("c", {}, colour));
  const TermId list = a.Variable(a.Declare("l", {}, a.List(pos)));
  const TermId k = a.FreshBound("k", a.Int());
  const TermId half = a.Number(a.Real(), *expr::Rational::Parse("-0.5"));
  const TermId x = a.Field(a.Select(v, i), 0);
  const std::vector<TermId> formulas{
      a.Lt(x, half),
      a.Lt(half, x),
      a.Eq(c, a.Member(colour, 1)),
      a.Forall({k}, a.Le(half, a.Field(a.Select(v, k), 0))),
      a.Eq(a.IntDiv(i, a.IntNumber(-3)), a.Mod(i, a.IntNumber(5))),
      a.Eq(a.At(list, i), a.Select(a.Store(v, i, a.At(list, a.Length(list))), a.Add(i, a.IntNumber(1)))),
      a.Not(
          a.Eq(a.Append(list, a.Select(v, i)), a.Remove(a.MakeList(pos, {a.Select(v, i)}), a.Select(v, i)))),
  };
  const z3::Z3Solver z3;
  const smtlib::SmtLibSolver cvc5("cvc5");
  int compared = 0;
  for (size_t first = 0; first < formulas.size(); ++first) {
    for (size_t second = 0; second < formulas.size(); ++second) {
      const Query query{&a, {{formulas[first], "one"}, {formulas[second], "two"}}, {}};
      const Answer here = z3.Check(query, {}, {});
      const Answer there = cvc5.Check(query, {}, {});
      if (const auto* unknown = std::get_if<Unknown>(&there)) {
        EXPECT_EQ(unknown->reason.find("error"), std::string::npos) << unknown->reason;
        continue;
      }
      if (std::holds_alternative<Unknown>(here)) continue;
      ++compared;
      EXPECT_EQ(here.index(), there.index()) << first << " " << second;
    }
  }
  EXPECT_GT(compared, 30);
}

}  // namespace
}  // namespace rondo::solve
