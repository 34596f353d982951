#include "solve/icp/icp_solver.h"

#include <gtest/gtest.h>

#include <numbers>

namespace rondo::solve::icp {
namespace {

using expr::Arena;
using expr::Elementary;
using expr::Rational;
using expr::TermId;

class Icp : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Constant(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  Query Asked(std::vector<TermId> formulas) {
    Query query{&arena_, {}, {}};
    for (const TermId f : formulas) query.assertions.push_back({f, "g"});
    return query;
  }
  Answer Ask(std::vector<TermId> formulas, const Options& options = {}, const Budget& budget = {}) {
    return IcpSolver(options).Check(Asked(std::move(formulas)), budget, {});
  }
  // The sine touches 1 at an irrational number: nothing excludes it, and nothing verifies it.
  std::vector<TermId> Touching() {
    const TermId wave = arena_.Apply(Elementary::kSin, {x_});
    return {arena_.Le(Number("1"), wave), arena_.Le(Number("1"), x_), arena_.Le(x_, Number("2"))};
  }

  Arena arena_;
  const TermId x_ = Constant("x", arena_.Real()), y_ = Constant("y", arena_.Real());
  const TermId xx_ = arena_.Mul(x_, x_), xy_ = arena_.Mul(x_, y_), one_ = Number("1");
};

TEST_F(Icp, WhatIsNotDecidedIsASmallBox) {
  const Answer answer = Ask(Touching());
  ASSERT_TRUE(std::holds_alternative<DeltaSat>(answer));
  const auto [lo, hi] = std::get<DeltaSat>(answer).box.at(x_);
  EXPECT_LE(lo, std::numbers::pi / 2);
  EXPECT_GE(hi, std::numbers::pi / 2);
  EXPECT_LT(hi - lo, 1e-3);
}

TEST_F(Icp, ABoxThatIsTooWideIsNoAnswer) {
  Options options;
  options.widest = 0;
  EXPECT_TRUE(std::holds_alternative<Unknown>(Ask(Touching(), options)));
}

TEST_F(Icp, TooManyBoxesAreNoAnswer) {
  Options options;
  options.max_boxes = 1;
  const auto wave = [&](TermId t) { return arena_.Apply(Elementary::kSin, {t}); };
  const TermId difference = arena_.Sub(arena_.Mul(x_, wave(y_)), arena_.Mul(y_, wave(x_)));
  std::vector<TermId> apart{arena_.Le(Number("0.5"), difference)};
  for (const TermId v : {x_, y_}) apart.push_back(arena_.And(arena_.Le(Number("-1"), v), arena_.Le(v, one_)));
  EXPECT_TRUE(std::holds_alternative<Unknown>(Ask(apart, options)));
  EXPECT_TRUE(std::holds_alternative<Unsat>(Ask(apart)));
}

TEST_F(Icp, ValuesHaveTheSortsOfTheQuery) {
  const expr::SortId colour = arena_.Enum("Colour", {"red", "green", "blue"});
  const TermId b = Constant("b", arena_.Bool()), n = Constant("n", arena_.Int()), c = Constant("c", colour);
  const Answer answer = Ask({arena_.Not(b), arena_.Eq(n, arena_.IntNumber(-4)),
                             arena_.Not(arena_.Eq(c, arena_.Member(colour, 0))),
                             arena_.Not(arena_.Eq(c, arena_.Member(colour, 1)))});
  ASSERT_TRUE(std::holds_alternative<Sat>(answer));
  const auto& values = std::get<Sat>(answer).values;
  EXPECT_EQ(values.at(b), Value{false});
  EXPECT_EQ(values.at(n), Value{Rational(-4)});
  EXPECT_EQ(values.at(c), Value{std::string("blue")});
}

TEST_F(Icp, IrrationalSolutionsAreCalledSo) {
  const Answer answer = Ask({arena_.Eq(xx_, Number("2")), arena_.Lt(Number("0"), x_)});
  ASSERT_TRUE(std::holds_alternative<Sat>(answer));
  EXPECT_FALSE(std::get<Sat>(answer).exact);
  EXPECT_NEAR(std::get<Sat>(answer).values.at(x_).AsNumber().ToDouble(), std::numbers::sqrt2, 1e-6);
}

TEST_F(Icp, CertificatesAreWrittenOnDemand) {
  const std::vector<TermId> wrong{arena_.Lt(arena_.Add(xx_, one_), Number("0"))};
  EXPECT_TRUE(std::get<Unsat>(Ask(wrong)).certificate.empty());
  EXPECT_FALSE(std::get<Unsat>(Ask(wrong, {}, {std::chrono::seconds(10), true, true})).certificate.empty());
}

TEST_F(Icp, GroupsAreNamedOnce) {
  EXPECT_EQ(std::get<Unsat>(Ask({arena_.Lt(x_, one_), arena_.Le(one_, x_)})).core,
            std::vector<std::string>{"g"});
}

TEST_F(Icp, ExactRefutationsNeedNoBoxes) {
  Statistics statistics;
  const Query query = Asked({arena_.Lt(xy_, one_), arena_.Le(one_, xy_)});
  EXPECT_TRUE(std::holds_alternative<Unsat>(IcpSolver().Check(query, {}, {}, statistics)));
  EXPECT_EQ(statistics.exact, 1u);
  EXPECT_EQ(statistics.boxes, 0u);
}

TEST_F(Icp, LemmasDoNotChangeTheAnswer) {
  // What is turned does not come nearer.
  const TermId u = Constant("u", arena_.Real());
  const TermId cosine = arena_.Apply(Elementary::kCos, {u}), sine = arena_.Apply(Elementary::kSin, {u});
  const TermId p = arena_.Add(arena_.Mul(x_, cosine), arena_.Mul(y_, sine));
  const TermId q = arena_.Sub(arena_.Mul(y_, cosine), arena_.Mul(x_, sine));
  const auto question = [&](const char* most) {
    const TermId inside = arena_.And(arena_.Le(p, Number(most)), arena_.Le(Number("-0.5"), p));
    return std::vector<TermId>{inside,
                               arena_.Le(q, Number(most)),
                               arena_.Le(Number("-0.5"), q),
                               arena_.Le(one_, x_),
                               arena_.Le(x_, Number("1.5")),
                               arena_.Le(Number("0"), y_),
                               arena_.Le(y_, Number("0.5"))};
  };
  for (const bool lemmas : {true, false}) {
    Options options;
    options.lemmas = lemmas;
    EXPECT_TRUE(std::holds_alternative<Unsat>(Ask(question("0.5"), options)));
    EXPECT_TRUE(std::holds_alternative<Sat>(Ask(question("1.5"), options)));
  }
}

TEST_F(Icp, UnboundedAnglesAreOneTurn) {
  const TermId wave = arena_.Apply(Elementary::kSin, {x_}), other = arena_.Apply(Elementary::kCos, {x_});
  EXPECT_TRUE(std::holds_alternative<Unsat>(Ask({arena_.Le(Number("1.5"), arena_.Add(wave, other))})));
  EXPECT_TRUE(std::holds_alternative<Sat>(
      Ask({arena_.Le(Number("1.4"), arena_.Add(wave, other)), arena_.Le(Number("1000"), x_)})));
}

TEST_F(Icp, AlternativesAreTriedOneByOne) {
  const TermId far = arena_.Or(arena_.Lt(x_, Number("-3")), arena_.Lt(Number("3"), x_));
  const TermId high = arena_.Or(arena_.Lt(y_, Number("-3")), arena_.Lt(Number("3"), y_));
  const TermId yy = arena_.Mul(y_, y_);
  EXPECT_TRUE(
      std::holds_alternative<Unsat>(Ask({far, high, arena_.Le(arena_.Add(xx_, yy), Number("17.9"))})));
  EXPECT_TRUE(std::holds_alternative<Sat>(Ask({far, high, arena_.Le(arena_.Add(xx_, yy), Number("19"))})));
}

TEST_F(Icp, EnclosuresKeepAllSolutions) {
  const auto box =
      IcpSolver().Enclose(Asked({arena_.Le(arena_.Add(xx_, arena_.Mul(y_, y_)), Number("4")),
                                 arena_.Eq(Constant("z", arena_.Real()), arena_.Add(x_, one_))}));
  ASSERT_TRUE(box.has_value());
  for (const TermId v : {x_, y_}) {
    EXPECT_LE(box->at(v).first, -2);
    EXPECT_GE(box->at(v).second, 2);
    EXPECT_NEAR(box->at(v).second, 2, 1e-6);
  }
  const auto [lo, hi] = box->at(Constant("z", arena_.Real()));
  EXPECT_LE(lo, -1);
  EXPECT_GE(hi, 3);
}

TEST_F(Icp, WhatHasNoSolutionHasNoEnclosure) {
  EXPECT_FALSE(IcpSolver().Enclose(Asked({arena_.Lt(x_, one_), arena_.Lt(one_, x_)})));
  EXPECT_FALSE(IcpSolver().Enclose(Asked({arena_.Le(Number("2"), arena_.Apply(Elementary::kSin, {xy_}))})));
}

TEST_F(Icp, WhatCannotBeToldHasNoEnclosure) {
  const TermId array = Constant("a", arena_.Array(arena_.Int(), arena_.Real()));
  EXPECT_FALSE(IcpSolver().Enclose(Asked({arena_.Lt(arena_.Select(array, arena_.IntNumber(0)), x_)})));
}

}  // namespace
}  // namespace rondo::solve::icp
