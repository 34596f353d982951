// What specifications may speak of, and what the checker makes of names in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/check/mentions_robot.h"
#include "koord/check/spec_labels.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

using diag::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kProgram =
    "def fun f(int k) -> int\ndef fun own(int k) -> int:\n    return k + pid\ndef fun twice(int k) -> int:\n"
    "    return k + k\n"
    "using M:\n    sensors:\n        int at\n        PathPlanner way\n    actuators:\n        int to\n"
    "using W:\n    sensors:\n        int heat\n"
    "param int p\nallread:\n    int x[N_sys]\nallwrite:\n    int s\nlocal:\n    int n\n    int a[3]\n"
    "E:\n    eff:\n        n = f(n)\n        M.to = M.way(n)\n";

class Specifications : public testing::Test {
 protected:
  std::vector<Kind> Reports(const std::string& text) {
    diagnostics_ = {};
    program_ = {};
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    std::vector<Kind> kinds;
    for (const diag::Diagnostic& d : diagnostics_.all()) kinds.push_back(d.kind);
    return kinds;
  }
  std::vector<Kind> Spec(const std::string& line) { return Reports(kProgram + line + "\n"); }
  void Accepts(std::initializer_list<const char*> lines) {
    for (const char* line : lines) EXPECT_THAT(Spec(line), IsEmpty()) << line;
  }
  void Rejects(Kind kind, std::initializer_list<const char*> lines) {
    for (const char* line : lines) EXPECT_THAT(Spec(line), ElementsAre(kind)) << line;
  }
  /// The program with `value` as the initial value of a local variable, and of one that all share.
  std::vector<Kind> Local(const std::string& value) { return Initial("local", value); }
  std::vector<Kind> Shared(const std::string& value) { return Initial("allwrite", value); }
  std::vector<Kind> Initial(const std::string& section, const std::string& value) {
    return Reports(
        "def fun f(int k) -> int\ndef fun own(int k) -> int:\n    return k + pid\nusing M:\n    sensors:\n        int at\n"
        "param int p\n" +
        section + ":\n    int v = " + value + "\nlocal:\n    int n\nE:\n    eff:\n        n = 0\n");
  }
  ExprId Body() const { return model_.invariants.at(0)->body; }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
};

TEST_F(Specifications, FactsSpeakOfParametersAndFunctions) {
  Accepts({"assume p > 0", "assume f(p) > N_sys", "assume forall k in int: f(k) > k", "assume twice(p) > 3"});
  Rejects(Kind::kKoordSpecScope, {"assume n > 0", "assume s > 0", "assume M.at > 0", "assume x[0] > 0",
                                  "assume M[0].at > 0", "assume pid > 0", "assume own(p) > 0"});
}

TEST_F(Specifications, InitialAssumptionsSpeakOfEverything) {
  Accepts({"assume initially: n > p and s == 0 and M.at > 0 and x[0] == 1 and M.to == 0"});
  Rejects(Kind::kKoordSpecScope, {"assume initially: old(n) == 0"});
}

TEST_F(Specifications, ControllerAssumptionsSpeakOfTheirModule) {
  Accepts({"assume M always M.at > p", "assume M.calm when M.at > 0 always M.at > 1"});
  Rejects(Kind::kKoordSpecScope, {"assume M always W.heat > 0", "assume M always n > 0",
                                  "assume M when s > 0 always M.at > 1", "assume M always M[0].at > 0"});
  Rejects(Kind::kKoordUndeclared, {"assume Motion always true"});
}

TEST_F(Specifications, AnActuatorNeedsACondition) {
  Accepts({"assume M when true always M.at < M.to"});
  Rejects(Kind::kKoordSpecScope, {"assume M always M.at < M.to"});
}

TEST_F(Specifications, OldStandsBehindAlways) {
  Accepts({"assume M always M.at >= old(M.at)"});
  Rejects(Kind::kKoordSpecScope,
          {"assume M always M.at >= old(M.at)\ninvariant: old(n) > 0",
           "assume M when old(M.at) > 0 always M.at > 0", "invariant: old(n) > 0", "assume old(p) > 0"});
}

TEST_F(Specifications, WhatAPlannerReturnsIsAssumedWithoutCondition) {
  Accepts({"assume M always M.way(3) > 0"});
  Rejects(Kind::kKoordSpecScope, {"assume M when M.at > 0 always M.way(3) > 0"});
}

TEST_F(Specifications, SummariesAreOfExternalFunctions) {
  Accepts({"summary f(k) -> y: y > k + p", "summary way(k) -> y: y > k"});
  Rejects(Kind::kKoordPointlessSpec, {"summary twice(k) -> y: y > k"});
  Rejects(Kind::kKoordArity, {"summary f(k, m) -> y: y > 0"});
  Rejects(Kind::kKoordNotBoolean, {"summary f(k) -> y: y + k"});
  Rejects(Kind::kKoordSpecScope,
          {"summary f(k) -> y: y > n", "summary f(k) -> y: y > pid", "summary f(k) -> y: y > own(k)"});
}

TEST_F(Specifications, SpecificationsAreTrueOrFalse) {
  Rejects(Kind::kKoordNotBoolean, {"invariant: n", "assume p + 1", "assume initially: n + 1",
                                   "assume M always M.at", "assume M when 1 always true"});
}

TEST_F(Specifications, ASpecificationNamesTheRobotFirst) {
  Accepts({"invariant: forall i in ID: n[i] > 0 and a[i][2] > 0 and x[i] > 0 and M[i].at > 0",
           "invariant: a[0][1] == n"});
  Rejects(Kind::kKoordTypeMismatch,
          {"invariant: a[0] == 1", "invariant: M[true].at > 0", "invariant: n[1.5] > 0"});
  Rejects(Kind::kKoordNotIndexable, {"invariant: s[0] > 0", "invariant: n[0][1] > 0"});
}

TEST_F(Specifications, CellsPortsAndOwnNamesAreToldApart) {
  ASSERT_THAT(Spec("invariant: n[1] > x[0]"), IsEmpty());
  const lang::Expr& comparison = program_.exprs[Body()];
  EXPECT_EQ(model_.RefOf(comparison.args[0]).kind, RefKind::kCell);
  EXPECT_EQ(model_.RefOf(comparison.args[1]).kind, RefKind::kCell);
  ASSERT_THAT(Spec("invariant: M[1].at > M.at"), IsEmpty());
  const lang::Expr& ports = program_.exprs[Body()];
  EXPECT_EQ(model_.RefOf(ports.args[0]).kind, RefKind::kPortOf);
  EXPECT_EQ(model_.RefOf(ports.args[1]).kind, RefKind::kVariable);
}

TEST_F(Specifications, QuantifiersRangeOverRobotsTypesAndLists) {
  const auto kind = [&](const std::string& domain) {
    EXPECT_THAT(Spec("invariant: forall i in " + domain + ": i >= 0"), IsEmpty()) << domain;
    return model_.domains.at(Body()).kinds.at(0);
  };
  EXPECT_EQ(kind("ID"), DomainKind::kRobots);
  EXPECT_EQ(kind("int"), DomainKind::kType);
  EXPECT_EQ(kind("[1, 2]"), DomainKind::kList);
  Rejects(Kind::kKoordTypeMismatch, {"invariant: forall i in n: i >= 0"});
}

TEST_F(Specifications, AVariableOfAQuantifierEndsWithIt) {
  Rejects(Kind::kKoordUndeclared, {"invariant: (forall i in ID: x[i] > 0) and i > 0 or false"});
}

TEST_F(Specifications, AnInitialValueIsMadeOfParametersFunctionsAndPid) {
  for (const char* value : {"3", "p + 1", "f(p)", "pid", "N_sys", "own(3)"})
    EXPECT_THAT(Local(value), IsEmpty()) << value;
  EXPECT_THAT(Local("M.at"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Local("v"), ElementsAre(Kind::kKoordSpecScope));
}

TEST_F(Specifications, WhatAllShareDoesNotBeginWithTheRobotsNumber) {
  for (const char* value : {"3", "p + 1", "f(p)", "N_sys"}) EXPECT_THAT(Shared(value), IsEmpty()) << value;
  EXPECT_THAT(Shared("pid"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(Shared("own(3)"), ElementsAre(Kind::kKoordSpecScope));
}

TEST_F(Specifications, ExplorationsGiveValuesToWhatHasNone) {
  const auto explore = [&](const std::string& entry) { return Spec("explore:\n    " + entry); };
  for (const char* entry : {"p = 3", "N_sys = 2", "N_sys in [1, 2]", "n in [0, p]", "M.at in [1, 2]",
                            "at in [1]", "f(k) = k + p", "way(k) = M.at + k", "M.at in grid(0, 9, 3)"})
    EXPECT_THAT(explore(entry), IsEmpty()) << entry;
  for (const char* entry : {"p in [1, 2]", "n = 3", "a in [1]", "twice(k) = k", "M.way = 3"})
    EXPECT_THAT(explore(entry), ElementsAre(Kind::kKoordPointlessSpec)) << entry;
  EXPECT_THAT(explore("q = 3"), ElementsAre(Kind::kKoordUndeclared));
  EXPECT_THAT(explore("p = 3\n    p = 4"), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(explore("p = 1.5"), ElementsAre(Kind::kKoordTypeMismatch));
  EXPECT_THAT(explore("f(k, m) = k"), ElementsAre(Kind::kKoordArity));
  EXPECT_THAT(explore("f(k) = n"), ElementsAre(Kind::kKoordSpecScope));
  EXPECT_THAT(explore("n in [s]"), ElementsAre(Kind::kKoordSpecScope));
}

TEST_F(Specifications, AGridStandsInExplorationsOnly) {
  Rejects(Kind::kKoordSpecScope, {"invariant: n in grid(0, 9, 3)"});
}

TEST_F(Specifications, CodeMentionsTheRobotByItselfOrThroughFunctions) {
  const auto mentions = [&](const std::string& formula) {
    EXPECT_THAT(Spec("invariant: " + formula), IsEmpty()) << formula;
    return RobotMentions(model_).In(Body());
  };
  for (const char* formula : {"pid > 0", "n > 0", "M.at > 0", "M.to > 0", "own(3) > 0", "twice(n) > 0"})
    EXPECT_TRUE(mentions(formula)) << formula;
  for (const char* formula : {"p > 0", "s > 0", "x[0] > 0", "f(p) > 0", "twice(3) > 0", "N_sys > 0"})
    EXPECT_FALSE(mentions(formula)) << formula;
}

TEST_F(Specifications, ArithmeticOnFloatsIsTold) {
  const auto uses = [&](const std::string& declaration, const std::string& formula) {
    EXPECT_THAT(
        Reports("param " + declaration + " v\nE:\n    eff:\n        stop\ninvariant: " + formula + "\n"),
        IsEmpty());
    return UsesFloatArithmetic(model_);
  };
  EXPECT_FALSE(uses("int", "v + 1 > 2"));
  EXPECT_FALSE(uses("float", "v > 2"));
  EXPECT_TRUE(uses("float", "v + 1 > 2"));
  EXPECT_TRUE(uses("pos", "v + v == v"));
  EXPECT_TRUE(uses("pos", "dist(v, v) > 2"));
}

}  // namespace
}  // namespace rondo::koord
