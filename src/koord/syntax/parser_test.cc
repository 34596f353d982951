// How programs are read: what binds to what, which dialects mean the same, and what is reported of broken texts.
#include "koord/syntax/parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "diag/diagnostic.h"
#include "koord/syntax/format.h"
#include "koord/syntax/json.h"

namespace rondo::koord {
namespace {

using diag::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

class Reading : public testing::Test {
 protected:
  std::vector<Kind> Reports(const std::string& text) {
    diagnostics_ = {};
    program_ = {};
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    std::vector<Kind> kinds;
    for (const diag::Diagnostic& d : diagnostics_.all()) kinds.push_back(d.kind);
    return kinds;
  }
  /// The program without what is written about it.
  std::string Meaning(const std::string& text) {
    Reports(text);
    EXPECT_FALSE(diagnostics_.has_errors()) << text << diagnostics_.all()[0].message;
    return Skeleton(program_);
  }
  std::string Of(const std::string& expression) {
    return Meaning("E:\n    eff:\n        x = " + expression + "\n");
  }
  template <typename T>
  const T& Only() const {
    const T* found = nullptr;
    for (const Item& item : program_.items) {
      if (const T* one = std::get_if<T>(&item)) found = one;
    }
    EXPECT_NE(found, nullptr);
    return *found;
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
};

TEST_F(Reading, OperatorsBindAsTheLanguageSays) {
  EXPECT_EQ(Of("a implies b or c"), Of("a implies (b or c)"));
  EXPECT_EQ(Of("a or b and c"), Of("a or (b and c)"));
  EXPECT_EQ(Of("not a and b"), Of("(not a) and b"));
  EXPECT_EQ(Of("not a == b"), Of("not (a == b)"));
  EXPECT_EQ(Of("a + b < c - d"), Of("(a + b) < (c - d)"));
  EXPECT_EQ(Of("a + b * c"), Of("a + (b * c)"));
  EXPECT_EQ(Of("-a * b"), Of("(-a) * b"));
  EXPECT_EQ(Of("a in b and c"), Of("(a in b) and c"));
}

TEST_F(Reading, EqualOperatorsBindToTheLeft) {
  EXPECT_EQ(Of("a - b - c"), Of("(a - b) - c"));
  EXPECT_EQ(Of("a / b * c"), Of("(a / b) * c"));
  EXPECT_NE(Of("a - b - c"), Of("a - (b - c)"));
}

TEST_F(Reading, ImplicationBindsToTheRight) {
  EXPECT_EQ(Of("a implies b implies c"), Of("a implies (b implies c)"));
}

TEST_F(Reading, AQuantifierReachesAsFarAsPossible) {
  EXPECT_EQ(Of("forall i in ID: a and b implies c"), Of("forall i in ID: (a and b implies c)"));
  EXPECT_NE(Of("(forall i in ID: a) and b"), Of("forall i in ID: a and b"));
}

TEST_F(Reading, SignsMeanTheirWords) {
  EXPECT_EQ(Of("!a && b || c"), Of("not a and b or c"));
  EXPECT_EQ(Of("True"), Of("true"));
  EXPECT_EQ(Of("False"), Of("false"));
  EXPECT_EQ(Of("a \xE2\x89\xA4 b"), Of("a <= b"));
  EXPECT_EQ(Of("a \xE2\x88\xA7 b"), Of("a and b"));
}

TEST_F(Reading, ComparisonsAreNotChained) {
  EXPECT_THAT(Reports("E:\n    pre: (a < b) == c\n    eff:\n        stop\n"), IsEmpty());
  EXPECT_THAT(Reports("E:\n    pre: a < b < c\n    eff:\n        stop\n"),
              ElementsAre(Kind::kSyntaxUnexpected));
}

TEST_F(Reading, EffMayGoOnInDeeperLines) {
  EXPECT_EQ(Meaning("E:\n    eff: a = 1\n        b = 2\n"),
            Meaning("E:\n    eff:\n        a = 1\n        b = 2\n"));
  EXPECT_EQ(Meaning("E:\n    eff: a = 1; b = 2\n"), Meaning("E:\n    eff:\n        a = 1\n        b = 2\n"));
}

TEST_F(Reading, AnIfMayStandOnOneLine) {
  EXPECT_EQ(Meaning("E:\n    eff:\n        if a: x = 1\n        else: x = 2\n"),
            Meaning("E:\n    eff:\n        if a:\n            x = 1\n        else:\n            x = 2\n"));
}

TEST_F(Reading, AnElseBelongsToTheIfOfItsDepth) {
  Reports(
      "E:\n    eff:\n        if a:\n            if b:\n                x = 1\n        else:\n            x = 2\n");
  const Stmt& outer = Only<EventDef>().body.at(0);
  EXPECT_TRUE(outer.has_else);
  EXPECT_FALSE(outer.body.at(0).has_else);
}

TEST_F(Reading, LinesAreJoined) {
  EXPECT_EQ(Of("1 + \\\n            2"), Of("1 + 2"));
  EXPECT_EQ(Of("max(1,\n  2)"), Of("max(1, 2)"));
}

TEST_F(Reading, UrgencyIsAWordBehindPre) {
  Reports("E:\n    pre urgent: a\n    eff:\n        stop\n");
  EXPECT_TRUE(Only<EventDef>().urgent);
  Reports("E:\n    pre: urgent\n    eff:\n        stop\n");
  EXPECT_FALSE(Only<EventDef>().urgent);
  EXPECT_TRUE(Only<EventDef>().pre.valid());
}

TEST_F(Reading, AnEventWithoutPreIsAlwaysEnabled) {
  Reports("E:\n    eff:\n        stop\n");
  EXPECT_FALSE(Only<EventDef>().pre.valid());
}

TEST_F(Reading, AssumptionsAreOfThreeKinds) {
  const auto read = [&](const std::string& line) -> const AssumeDef& {
    EXPECT_THAT(Reports(line + "\n"), IsEmpty()) << line;
    return Only<AssumeDef>();
  };
  EXPECT_EQ(read("assume a > 0").kind, AssumeKind::kFact);
  EXPECT_EQ(read("assume high: a > 0").name, "high");
  EXPECT_EQ(read("assume initially: a > 0").kind, AssumeKind::kInitially);
  EXPECT_EQ(read("assume M always a > 0").kind, AssumeKind::kPort);
  EXPECT_FALSE(read("assume M always a > 0").when.valid());
  const AssumeDef& promise = read("assume M.calm when a\n    always b");
  EXPECT_EQ(promise.module + " " + promise.name, "M calm");
  EXPECT_TRUE(promise.when.valid());
}

TEST_F(Reading, WordsOfSpecificationsAreNamesElsewhere) {
  EXPECT_THAT(
      Reports(
          "local:\n    int param\n    int invariant\n    int explore\nE:\n    eff:\n        param = invariant + explore\n"),
      IsEmpty());
  EXPECT_THAT(Reports("explore:\n    pre: true\n    eff:\n        stop\n"), IsEmpty());
  EXPECT_EQ(Only<EventDef>().name, "explore");
}

TEST_F(Reading, WordsOfTheLanguageNameNothing) {
  for (const char* word : {"atomic", "pid", "forall", "if", "pre", "stop", "True"}) {
    EXPECT_TRUE(IsReservedWord(word)) << word;
    EXPECT_THAT(Reports(std::string("local:\n    int ") + word + "\nE:\n    eff:\n        stop\n"),
                testing::Contains(Kind::kSyntaxReservedName))
        << word;
  }
  for (const char* word : {"", "Atomic", "invariant", "urgent", "initially", "x"})
    EXPECT_FALSE(IsReservedWord(word)) << word;
}

TEST_F(Reading, EachBrokenLineIsReportedAndTheRestIsRead) {
  EXPECT_THAT(
      Reports("E:\n    eff:\n        x = = 1\n        y = 2\n        z + 1\nF:\n    eff:\n        stop\n"),
      ElementsAre(Kind::kSyntaxUnexpected, Kind::kSyntaxUnexpected));
  EXPECT_EQ(program_.items.size(), 2U);
  EXPECT_EQ(Only<EventDef>().name, "F");
}

TEST_F(Reading, IndentationNeedsAReason) {
  EXPECT_THAT(Reports("E:\n    eff:\n        x = 1\n            y = 2\n"),
              ElementsAre(Kind::kSyntaxIndentation));
  EXPECT_THAT(Reports("    E:\n        eff:\n            stop\n"), ElementsAre(Kind::kSyntaxIndentation));
}

TEST_F(Reading, TabsAreAWarning) {
  EXPECT_THAT(Reports("E:\n\teff:\n\t\tstop\n"), testing::Contains(Kind::kSyntaxTab));
  EXPECT_FALSE(diagnostics_.has_errors());
}

TEST_F(Reading, DeepNestingIsRefusedAndNotFatal) {
  std::string text = "E:\n    eff:\n";
  for (size_t depth = 0; depth < 100; ++depth) text += std::string(8 + depth, ' ') + "atomic:\n";
  Reports(text + std::string(108, ' ') + "stop\n");
  EXPECT_TRUE(diagnostics_.has_errors());
  Reports("E:\n    pre: " + std::string(100'000, '(') + "\n");
  EXPECT_TRUE(diagnostics_.has_errors());
}

TEST_F(Reading, NoTextIsFatal) {
  const std::string text =
      "local:\n    int n = (1\nE:\n    pre: a\n    eff:\n        if a:\n            n = [1, \"x\n";
  for (size_t length = 0; length <= text.size(); ++length) Reports(text.substr(0, length));
  Reports(std::string("\0\xFF\xFE\n\x01", 5));
  EXPECT_TRUE(diagnostics_.has_errors());
}

TEST_F(Reading, TwoFilesAreOneProgram) {
  Parse(sources_, sources_.Add("a.koord", "E:\n    eff:\n        stop\n"), program_, diagnostics_);
  Parse(sources_, sources_.Add("a.spec", "invariant: true\n"), program_, diagnostics_);
  EXPECT_EQ(program_.items.size(), 2U);
  EXPECT_EQ(program_.item_spans.size(), 2U);
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(Reading, EveryKindOfExpressionHasANameInTheTree) {
  Reports("local:\n    int n\nE:\n    eff:\n        n = any k in [1, 2]\n");
  EXPECT_NE(ToJson(sources_, program_).dump().find("\"expr\":\"any\""), std::string::npos);
}

}  // namespace
}  // namespace rondo::koord
