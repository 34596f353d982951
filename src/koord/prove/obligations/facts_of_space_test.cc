// What is said of distances and of extreme values is true, and excludes what is not.
#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/prove/obligations/distances.h"
#include "koord/prove/obligations/extremes.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

class Facts : public testing::Test {
 protected:
  Facts() {
    Parse(sources_,
          sources_.Add("test.koord",
                       "allread:\n    int x[N_sys]\n    int y[N_sys]\nE:\n    eff:\n        x[pid] = 0\n"),
          program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
  }
  bool Satisfiable(const std::vector<TermId>& formulas) {
    solve::Query query{&arena_, {}, {}};
    for (const TermId f : formulas) query.assertions.push_back({f, ""});
    const solve::Answer answer = solver_.Check(query, {}, {});
    EXPECT_TRUE(std::holds_alternative<solve::Sat>(answer) || std::holds_alternative<solve::Unsat>(answer));
    return std::holds_alternative<solve::Sat>(answer);
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  expr::Arena arena_;
  solve::z3::Z3Solver solver_;
};

class DistanceFacts : public Facts {
 protected:
  TermId Real(const expr::Rational& value) { return arena_.Number(arena_.Real(), value); }
  TermId Real(int64_t value) { return Real(expr::Rational(value)); }
  TermId Point(const char* name) { return arena_.FreshConstant(name, pos_); }
  TermId Point(int64_t x, int64_t y, int64_t z) {
    return arena_.MakeRecord(pos_, {Real(x), Real(y), Real(z)});
  }
  TermId Dist(TermId p, TermId q) { return arena_.Apply(vocabulary_.Dist(), {p, q}); }
  /// Is the claim compatible with what is known of the distances in it?
  bool Allowed(TermId claim, Distances::Detail detail = Distances::Detail::kAll) {
    Distances known(vocabulary_, detail);
    std::vector<TermId> formulas{claim};
    for (std::vector<TermId> more = known.Axioms(formulas); !more.empty(); more = known.Axioms(more))
      formulas.insert(formulas.end(), more.begin(), more.end());
    return Satisfiable(formulas);
  }
  bool Allowed(std::vector<TermId> claims) { return Allowed(arena_.And(claims)); }

  Vocabulary vocabulary_{arena_, model_, std::nullopt};
  SortId pos_ = vocabulary_.SortOf(model_.types.pos());
  TermId p_ = Point("p");
  TermId q_ = Point("q");
  TermId r_ = Point("r");
};

TEST_F(DistanceFacts, NoDistanceIsNegative) {
  for (const auto detail : {Distances::Detail::kDistance, Distances::Detail::kAll}) {
    EXPECT_FALSE(Allowed(arena_.Lt(Dist(p_, q_), Real(0)), detail));
    EXPECT_TRUE(Allowed(arena_.Eq(Dist(p_, q_), Real(0)), detail));
  }
}

TEST_F(DistanceFacts, BothDirectionsAreEqual) {
  for (const auto detail : {Distances::Detail::kDistance, Distances::Detail::kAll})
    EXPECT_FALSE(Allowed(arena_.Lt(Dist(p_, q_), Dist(q_, p_)), detail));
}

TEST_F(DistanceFacts, EqualPointsAloneHaveNoDistance) {
  const TermId zero = arena_.Eq(Dist(p_, q_), Real(0));
  const TermId same = arena_.Eq(p_, q_);
  EXPECT_FALSE(Allowed({zero, arena_.Not(same)}));
  EXPECT_FALSE(Allowed({arena_.Not(zero), same}));
  EXPECT_TRUE(Allowed({zero, same}));
}

TEST_F(DistanceFacts, TwoSidesOfATriangleAreNoShorterThanTheThird) {
  const auto sides = [&](int64_t pq, int64_t qr, int64_t pr) {
    return Allowed({arena_.Eq(Dist(p_, q_), Real(pq)), arena_.Eq(Dist(q_, r_), Real(qr)),
                    arena_.Eq(Dist(p_, r_), Real(pr))});
  };
  EXPECT_TRUE(sides(3, 4, 5));
  EXPECT_TRUE(sides(1, 2, 3));
  EXPECT_FALSE(sides(1, 2, 4));
  EXPECT_FALSE(sides(4, 1, 2));
  EXPECT_FALSE(sides(1, 4, 2));
}

TEST_F(DistanceFacts, CoordinatesDifferByNoMoreThanTheDistance) {
  const TermId one = arena_.Eq(Dist(p_, q_), Real(1));
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const TermId a = arena_.Field(p_, axis);
    const TermId b = arena_.Field(q_, axis);
    EXPECT_FALSE(Allowed({one, arena_.Lt(Real(1), arena_.Sub(a, b))})) << axis;
    EXPECT_FALSE(Allowed({one, arena_.Lt(Real(1), arena_.Sub(b, a))})) << axis;
    EXPECT_TRUE(Allowed({one, arena_.Eq(Real(1), arena_.Sub(b, a))})) << axis;
  }
}

TEST_F(DistanceFacts, AlongAnAxisTheDistanceIsKnown) {
  for (const auto& [p, q] : {std::pair(Point(1, 2, 3), Point(5, 2, 3)),
                             {Point(1, 6, 3), Point(1, 2, 3)},
                             {Point(1, 2, 0), Point(1, 2, 4)}}) {
    EXPECT_TRUE(Allowed(arena_.Eq(Dist(p, q), Real(4))));
    EXPECT_FALSE(Allowed(arena_.Not(arena_.Eq(Dist(p, q), Real(4)))));
  }
}

TEST_F(DistanceFacts, TheTrueDistanceIsNeverExcluded) {
  const TermId a = Point(0, 0, 0);
  const TermId b = Point(3, 4, 0);
  const TermId c = Point(3, 4, 12);
  EXPECT_TRUE(Allowed(
      {arena_.Eq(Dist(a, b), Real(5)), arena_.Eq(Dist(b, c), Real(12)), arena_.Eq(Dist(a, c), Real(13))}));
  EXPECT_FALSE(Allowed(arena_.Eq(Dist(a, b), Real(8))));
  EXPECT_FALSE(Allowed(arena_.Eq(Dist(a, b), Real(3))));
}

TEST_F(DistanceFacts, TheMiddleIsHalfAsFar) {
  const TermId half = Real(expr::Rational(1) / expr::Rational(2));
  std::vector<TermId> parts;
  for (uint32_t i = 0; i < 3; ++i)
    parts.push_back(arena_.Mul(half, arena_.Add(arena_.Field(p_, i), arena_.Field(q_, i))));
  const TermId middle = arena_.MakeRecord(pos_, parts);
  const TermId whole = arena_.Eq(Dist(p_, q_), Real(6));
  EXPECT_TRUE(Allowed({whole, arena_.Eq(Dist(middle, p_), Real(3)), arena_.Eq(Dist(middle, q_), Real(3))}));
  EXPECT_FALSE(Allowed({whole, arena_.Eq(Dist(middle, p_), Real(4))}));
}

TEST_F(DistanceFacts, NothingIsSaidTwice) {
  Distances known(vocabulary_, Distances::Detail::kAll);
  const TermId claim = arena_.Lt(Dist(p_, q_), Real(1));
  EXPECT_FALSE(known.Axioms({claim}).empty());
  EXPECT_TRUE(known.Axioms({claim}).empty());
}

TEST_F(DistanceFacts, ModelsAlongAxesAreInSpace) {
  const TermId claim = arena_.Lt(Dist(p_, q_), Real(9));
  const TermId along = AlongAxes(vocabulary_, {claim});
  const auto differs = [&](uint32_t axis) {
    return arena_.Not(arena_.Eq(arena_.Field(p_, axis), arena_.Field(q_, axis)));
  };
  for (uint32_t axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(Satisfiable({along, differs(axis)}));
    EXPECT_FALSE(Satisfiable({along, differs(axis), differs((axis + 1) % 3)}));
  }
}

TEST_F(DistanceFacts, AQuantifierMaySpeakOfAnyPoints) {
  const TermId any = arena_.FreshBound("any", pos_);
  const TermId open = arena_.Forall({any}, arena_.Lt(Dist(p_, any), Real(9)));
  EXPECT_TRUE(HasDistanceOfAnyPoints(vocabulary_, {open}));
  EXPECT_FALSE(HasDistanceOfAnyPoints(vocabulary_, {arena_.Lt(Dist(p_, q_), Real(9))}));
}

class ExtremeFacts : public Facts {
 protected:
  TermId Of(size_t variable, TermId robot) { return arena_.Select(view_.value[variable], robot); }
  /// Somebody is such that `relation(i, j)` holds for all robots j.
  TermId Somebody(const std::function<TermId(TermId, TermId)>& relation) {
    const TermId i = arena_.FreshBound("i", arena_.Int());
    const TermId j = arena_.FreshBound("j", arena_.Int());
    const TermId all = arena_.Forall({j}, arena_.Implies(vocabulary_.IsRobot(j), relation(i, j)));
    return arena_.Exists({i}, arena_.And(vocabulary_.IsRobot(i), all));
  }
  std::vector<TermId> Axioms(TermId formula) { return solve::Formulas(extremes_.Axioms({{formula, ""}})); }

  Vocabulary vocabulary_{arena_, model_, 3};
  View view_ = vocabulary_.MakeView("");
  Extremes extremes_{vocabulary_};
};

TEST_F(ExtremeFacts, SomebodyIsLargestAndSomebodyLeast) {
  const TermId largest = Somebody([&](TermId i, TermId j) { return arena_.Le(Of(0, j), Of(0, i)); });
  const TermId least = Somebody([&](TermId i, TermId j) { return arena_.Le(Of(0, i), Of(0, j)); });
  const std::vector<TermId> axioms = Axioms(largest);
  ASSERT_EQ(axioms.size(), 2U);
  std::vector<TermId> contrary = axioms;
  contrary.push_back(arena_.Not(arena_.And(largest, least)));
  EXPECT_FALSE(Satisfiable(contrary));
}

TEST_F(ExtremeFacts, NobodyIsLargerThanHimself) {
  const TermId above = Somebody([&](TermId i, TermId j) { return arena_.Lt(Of(0, j), Of(0, i)); });
  std::vector<TermId> formulas = Axioms(above);
  EXPECT_TRUE(Satisfiable(formulas));
  formulas.push_back(above);
  EXPECT_FALSE(Satisfiable(formulas));
}

TEST_F(ExtremeFacts, DifferentValuesAreNotCompared) {
  EXPECT_TRUE(Axioms(Somebody([&](TermId i, TermId j) { return arena_.Le(Of(0, j), Of(1, i)); })).empty());
}

TEST_F(ExtremeFacts, OneKindOfQuantifierNeedsNoExtreme) {
  const TermId i = arena_.FreshBound("i", arena_.Int());
  const TermId j = arena_.FreshBound("j", arena_.Int());
  EXPECT_TRUE(Axioms(arena_.Forall({i, j}, arena_.Le(Of(0, j), Of(0, i)))).empty());
}

TEST_F(ExtremeFacts, TheSameValueHasTheSameAxioms) {
  const auto relation = [&](TermId i, TermId j) { return arena_.Le(Of(0, j), Of(0, i)); };
  EXPECT_EQ(Axioms(Somebody(relation)), Axioms(Somebody(relation)));
}

}  // namespace
}  // namespace rondo::koord
