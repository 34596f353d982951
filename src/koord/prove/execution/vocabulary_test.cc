#include "koord/prove/execution/vocabulary.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

class Vocabularies : public testing::Test {
 protected:
  void Load(const std::string& declarations, const std::string& effect = "n = 0") {
    const std::string all = declarations + "local:\n    int n\nE:\n    eff:\n        " + effect + "\n";
    Parse(sources_, sources_.Add("test.koord", all), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
  }
  size_t Find(const std::string& name) const {
    size_t v = 0;
    while (model_.variables.at(v).name != name) ++v;
    return v;
  }
  /// Does the claim follow from the axioms of the vocabulary?
  bool Follows(Vocabulary& vocabulary, TermId claim) {
    solve::Query query{&arena_, {{arena_.Not(claim), ""}}, {}};
    for (const TermId axiom : vocabulary.Axioms()) query.assertions.push_back({axiom, ""});
    return std::holds_alternative<solve::Unsat>(solver_.Check(query, {}, {}));
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  expr::Arena arena_;
  solve::z3::Z3Solver solver_;
};

TEST_F(Vocabularies, ThereIsARobotButNotNecessarilyTwo) {
  Load("");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  EXPECT_TRUE(Follows(vocabulary, vocabulary.IsRobot(arena_.IntNumber(0))));
  EXPECT_FALSE(Follows(vocabulary, vocabulary.IsRobot(arena_.IntNumber(1))));
  EXPECT_FALSE(Follows(vocabulary, arena_.Not(vocabulary.IsRobot(arena_.IntNumber(1)))));
}

TEST_F(Vocabularies, RobotsAreFromZeroBelowTheirNumber) {
  Load("");
  Vocabulary vocabulary(arena_, model_, 3);
  EXPECT_EQ(vocabulary.IsRobot(arena_.IntNumber(-1)), arena_.False());
  EXPECT_EQ(vocabulary.IsRobot(arena_.IntNumber(0)), arena_.True());
  EXPECT_EQ(vocabulary.IsRobot(arena_.IntNumber(2)), arena_.True());
  EXPECT_EQ(vocabulary.IsRobot(arena_.IntNumber(3)), arena_.False());
}

TEST_F(Vocabularies, TwoMomentsShareParametersOnly) {
  Load("param int p\nallwrite:\n    int s\n");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  const View now = vocabulary.MakeView("");
  const View then = vocabulary.MakeView("'");
  EXPECT_EQ(now.value[Find("p")], then.value[Find("p")]);
  EXPECT_NE(now.value[Find("s")], then.value[Find("s")]);
  EXPECT_NE(now.value[Find("n")], then.value[Find("n")]);
  EXPECT_NE(now.stopped, then.stopped);
}

TEST_F(Vocabularies, WhatEachRobotHasIsAnArrayOverRobots) {
  Load("allread:\n    int x[N_sys]\nallwrite:\n    int s\n");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  const View view = vocabulary.MakeView("");
  const expr::SortId robots = arena_.Array(arena_.Int(), arena_.Int());
  EXPECT_EQ(arena_.sort_of(view.value[Find("x")]), robots);
  EXPECT_EQ(arena_.sort_of(view.value[Find("n")]), robots);
  EXPECT_EQ(arena_.sort_of(view.value[Find("s")]), arena_.Int());
}

TEST_F(Vocabularies, TypesBecomeSorts) {
  Load("def stage {pick, go}\nlocal:\n    stage s\n    List<float> l\n    Motor m\n    bool g[2][3]\n");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  EXPECT_EQ(arena_.sort(vocabulary.CellSort(Find("s"))).names, (std::vector<std::string>{"pick", "go"}));
  EXPECT_EQ(vocabulary.CellSort(Find("l")), arena_.List(arena_.Real()));
  EXPECT_EQ(arena_.sort(vocabulary.CellSort(Find("m"))).kind, expr::SortKind::kOpaque);
  EXPECT_EQ(vocabulary.CellSort(Find("g")),
            arena_.Array(arena_.Int(), arena_.Array(arena_.Int(), arena_.Bool())));
}

TEST_F(Vocabularies, DifferentTextsDiffer) {
  Load("");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  const TermId a = vocabulary.StringLiteral("a");
  const TermId b = vocabulary.StringLiteral("b");
  const TermId c = vocabulary.StringLiteral("c");
  EXPECT_EQ(a, vocabulary.StringLiteral("a"));
  for (const auto& [x, y] : {std::pair(a, b), {a, c}, {b, c}})
    EXPECT_TRUE(Follows(vocabulary, arena_.Not(arena_.Eq(x, y))));
}

TEST_F(Vocabularies, NamesOfTheProgramDoNotMeetOurOwn) {
  Load("def fun literal(int k) -> int\nallwrite:\n    int number\n    int has\n");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  const View view = vocabulary.MakeView("");
  EXPECT_NE(view.value[Find("number")], vocabulary.robots());
  EXPECT_NE(arena_.symbol(vocabulary.Function(0, "")).name, "literal");
}

TEST_F(Vocabularies, APlannerTakesTheRobotAndHasAVersion) {
  Load("using M:\n    sensors:\n        PathPlanner way\n    actuators:\n        pos to\n",
       "M.to = M.way(pos(1, 2, 3))");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  const expr::SymbolId now = vocabulary.Function(0, "");
  const expr::SymbolId then = vocabulary.Function(0, "'");
  EXPECT_NE(now, then);
  ASSERT_EQ(arena_.symbol(now).parameters.size(), 2U);
  EXPECT_EQ(arena_.symbol(now).parameters[0], arena_.Int());
}

TEST_F(Vocabularies, OnlyAProgramThatSaysStopStops) {
  Load("");
  EXPECT_FALSE(Vocabulary(arena_, model_, std::nullopt).robots_stop());
  program_ = {};
  Load("", "if n > 0:\n            for i = 0, 2:\n                stop");
  EXPECT_TRUE(Vocabulary(arena_, model_, std::nullopt).robots_stop());
}

TEST_F(Vocabularies, DistancesAreMarked) {
  Load("");
  Vocabulary vocabulary(arena_, model_, std::nullopt);
  EXPECT_FALSE(vocabulary.uses_dist());
  vocabulary.Dist();
  EXPECT_TRUE(vocabulary.uses_dist());
}

}  // namespace
}  // namespace rondo::koord
