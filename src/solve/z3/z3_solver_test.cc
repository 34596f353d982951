#include "solve/z3/z3_solver.h"

#include <gtest/gtest.h>

namespace rondo::solve::z3 {
namespace {

using expr::Arena;
using expr::TermId;

class Z3 : public testing::Test {
 protected:
  Answer Check(std::vector<Assertion> assertions, std::vector<TermId> wanted = {}) {
    return Z3Solver().Check({&arena_, std::move(assertions), std::move(wanted)}, {}, {});
  }
  TermId Const(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }

  Arena arena_;
};

TEST_F(Z3, NamesTheGroupsOfARefutation) {
  const TermId x = Const("x", arena_.Real());
  const TermId zero = arena_.Number(arena_.Real(), 0);
  const Answer answer = Check({{arena_.Lt(x, zero), "low"},
                               {arena_.Lt(zero, x), "high"},
                               {arena_.Not(arena_.Eq(x, zero)), "unused"}});
  ASSERT_TRUE(std::holds_alternative<Unsat>(answer));
  EXPECT_EQ(std::get<Unsat>(answer).core, (std::vector<std::string>{"high", "low"}));
}

TEST_F(Z3, ReadsValuesOfEverySort) {
  const expr::SortId colour = arena_.Enum("Colour", {"red", "green"});
  const expr::SortId pos = arena_.Record("pos", {"x", "y"}, {arena_.Real(), arena_.Real()});
  const TermId c = Const("c", colour);
  const TermId p = Const("p", pos);
  const TermId n = Const("n", arena_.Int());
  const TermId third = arena_.Number(arena_.Real(), expr::Rational(1) / expr::Rational(3));
  const TermId q = arena_.MakeRecord(pos, {third, arena_.Number(arena_.Real(), -2)});
  const Answer answer = Check({{arena_.Eq(c, arena_.Member(colour, 1)), ""},
                               {arena_.Eq(p, q), ""},
                               {arena_.Eq(n, arena_.IntNumber(-7)), ""}},
                              {c, p, n});
  ASSERT_TRUE(std::holds_alternative<Sat>(answer));
  const auto& values = std::get<Sat>(answer).values;
  EXPECT_EQ(ToString(values.at(c)), "green");
  EXPECT_EQ(ToString(values.at(p)), "(1/3, -2)");
  EXPECT_EQ(ToString(values.at(n)), "-7");
}

TEST_F(Z3, ACancelledTokenStopsTheEngine) {
  const base::StopToken stop;
  stop.RequestStop();
  const Answer answer = Z3Solver().Check({&arena_, {}, {}}, {}, stop);
  ASSERT_TRUE(std::holds_alternative<Unknown>(answer));
  EXPECT_EQ(std::get<Unknown>(answer).reason, "interrupted");
}

}  // namespace
}  // namespace rondo::solve::z3
