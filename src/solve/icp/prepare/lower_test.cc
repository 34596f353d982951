#include "solve/icp/prepare/lower.h"

#include <gtest/gtest.h>

#include <map>

#include "expr/evaluate.h"
#include "expr/substitute.h"

namespace rondo::solve::icp {
namespace {

using expr::Op;

class Lowering : public testing::Test {
 protected:
  TermId Constant(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  TermId Number(int value) { return arena_.Number(arena_.Real(), Rational(value)); }
  const Lowered& Of(TermId formula) {
    Lower({&arena_, {{formula, ""}}, {}}, lowered_);
    return lowered_;
  }
  // Do all conjuncts hold where variables have these values, by name?
  bool Holds(const std::map<std::string, Rational>& values) const {
    const auto value = [&](TermId t) -> std::optional<expr::Value> {
      const auto it = values.find(lowered_.arena.symbol(lowered_.arena.symbol_of(t)).name);
      return it == values.end() ? std::nullopt : std::optional(expr::Value{it->second});
    };
    for (const TermId c : lowered_.conjuncts) {
      if (!expr::Evaluate(lowered_.arena, c, value).value().AsBool()) return false;
    }
    return true;
  }
  // The only variable.
  const Variable& Only() const {
    EXPECT_EQ(lowered_.variables.size(), 1u);
    return lowered_.variables.begin()->second;
  }

  expr::Arena arena_;
  Lowered lowered_;
  const TermId x_ = Constant("x", arena_.Real()), y_ = Constant("y", arena_.Real());
  const TermId b_ = Constant("b", arena_.Bool()), d_ = Constant("d", arena_.Bool());
};

TEST_F(Lowering, TruthValuesAreZeroOrOne) {
  Of(b_);
  EXPECT_EQ(Only().kind, Variable::Kind::kBool);
  EXPECT_TRUE(Only().integral());
  EXPECT_TRUE(Holds({{"b", 1}}));
  EXPECT_FALSE(Holds({{"b", 0}}));
  EXPECT_FALSE(Holds({{"b", 2}}));
}

TEST_F(Lowering, MembersAreTheirPlacesInTheEnumeration) {
  const expr::SortId colour = arena_.Enum("Colour", {"red", "green", "blue"});
  Of(arena_.Not(arena_.Eq(Constant("c", colour), arena_.Member(colour, 1))));
  EXPECT_EQ(Only().kind, Variable::Kind::kEnum);
  EXPECT_TRUE(Holds({{"c", 0}}));
  EXPECT_FALSE(Holds({{"c", 1}}));
  EXPECT_TRUE(Holds({{"c", 2}}));
  EXPECT_FALSE(Holds({{"c", 3}}));
  EXPECT_FALSE(Holds({{"c", -1}}));
}

TEST_F(Lowering, IntegersAreIntegralAndRealsAreNot) {
  const TermId n = Constant("n", arena_.Int());
  Of(arena_.Le(x_, arena_.ToReal(n)));
  ASSERT_EQ(lowered_.variables.size(), 2u);
  for (const auto& [term, variable] : lowered_.variables) {
    EXPECT_EQ(variable.integral(), variable.source == n);
    EXPECT_EQ(lowered_.arena.sort_of(term), lowered_.arena.Real());
  }
}

TEST_F(Lowering, EqualTruthValuesAreBothOrNeither) {
  Of(arena_.Eq(b_, d_));
  for (const int b : {0, 1}) {
    for (const int d : {0, 1}) EXPECT_EQ(Holds({{"b", b}, {"d", d}}), b == d);
  }
}

TEST_F(Lowering, DifferentTruthValuesAreOneOfThem) {
  Of(arena_.Not(arena_.Eq(b_, d_)));
  for (const int b : {0, 1}) {
    for (const int d : {0, 1}) EXPECT_EQ(Holds({{"b", b}, {"d", d}}), b != d);
  }
}

TEST_F(Lowering, ChoicesOfFormulasAndOfNumbersKeepTheirConditions) {
  const TermId number = arena_.Ite(b_, x_, y_);
  Of(arena_.Ite(d_, arena_.Lt(number, Number(0)), arena_.Lt(Number(0), number)));
  for (const int b : {0, 1}) {
    for (const int d : {0, 1}) {
      const int chosen = b == 1 ? -1 : 1;
      EXPECT_EQ(Holds({{"b", b}, {"d", d}, {"x", -1}, {"y", 1}}), d == 1 ? chosen < 0 : chosen > 0);
    }
  }
}

TEST_F(Lowering, NegationsStandBeforeEquationsOnly) {
  const TermId equal = arena_.Eq(x_, y_);
  Of(arena_.Not(arena_.And(arena_.Or(b_, equal), arena_.Or(arena_.Le(x_, y_), arena_.Not(d_)))));
  std::unordered_set<TermId> seen;
  for (const TermId c : lowered_.conjuncts) {
    expr::VisitPostorder(lowered_.arena, c, seen, [&](TermId t) {
      EXPECT_TRUE(lowered_.arena.op(t) != Op::kNot || lowered_.arena.op(lowered_.arena.arg(t, 0)) == Op::kEq);
    });
  }
}

TEST_F(Lowering, NegationHoldsWhereTheFormulaDoesNot) {
  const TermId f = arena_.And(arena_.Or(arena_.Lt(x_, Number(0)), arena_.Eq(y_, Number(1))),
                              arena_.Not(arena_.Eq(x_, Number(-1))));
  const TermId g = Negate(arena_, f);
  for (int x = -2; x <= 1; ++x) {
    for (int y = 0; y <= 2; ++y) {
      const auto at = [&](TermId t) { return expr::Value{Rational(t == x_ ? x : y)}; };
      EXPECT_NE(expr::Evaluate(arena_, f, at)->AsBool(), expr::Evaluate(arena_, g, at)->AsBool());
    }
  }
}

TEST_F(Lowering, WhatIntervalsCannotTellIsNamed) {
  const TermId n = Constant("n", arena_.Int());
  const TermId array = Constant("a", arena_.Array(arena_.Int(), arena_.Real()));
  const expr::SymbolId f = arena_.Declare("f", {arena_.Real()}, arena_.Real());
  const TermId bound = arena_.FreshBound("i", arena_.Real());
  const TermId opaque = Constant("o", arena_.Opaque("Thing"));
  for (const TermId formula :
       {arena_.Lt(arena_.Select(array, n), x_), arena_.Lt(arena_.Apply(f, std::vector<TermId>{x_}), x_),
        arena_.Forall({bound}, arena_.Lt(bound, x_)),
        arena_.Eq(arena_.Mod(n, arena_.IntNumber(2)), arena_.IntNumber(0)),
        arena_.Eq(opaque, Constant("p", arena_.Opaque("Thing")))}) {
    Lowered lowered;
    Lower({&arena_, {{formula, ""}}, {}}, lowered);
    EXPECT_FALSE(lowered.unsupported.empty());
  }
}

}  // namespace
}  // namespace rondo::solve::icp
