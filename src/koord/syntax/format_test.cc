// The canonical form of programs: the same meaning, the same comments, and nothing left to change.
#include "koord/syntax/format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diag/diagnostic.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

// A text that must parse without errors.
struct Parsed {
  explicit Parsed(const std::string& text) {
    Parse(sources, sources.Add("test.koord", text), program, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << text << diagnostics.all()[0].message;
  }
  std::vector<std::string> Comments() const {
    std::vector<std::string> texts;
    for (const lang::Comment& c : program.comments) texts.push_back(c.text);
    return texts;
  }
  std::string Canonical() const { return Format(sources, program); }

  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  Program program;
};

std::string Canonical(const std::string& text) { return Parsed(text).Canonical(); }

/// Formats the text, and expects that this changes no meaning, loses no comment and leaves nothing to do.
void ExpectSafe(const std::string& text) {
  const Parsed before(text);
  const std::string formatted = before.Canonical();
  const Parsed after(formatted);
  EXPECT_EQ(Skeleton(before.program), Skeleton(after.program)) << text;
  EXPECT_EQ(before.Comments(), after.Comments()) << text << "became\n" << formatted;
  EXPECT_EQ(after.Canonical(), formatted) << text;
}

/// An event with these statements.
std::string Event(const std::string& statements) { return "E:\n    eff:\n        " + statements + "\n"; }

TEST(Format, StatementsKeepTheirMeaning) {
  for (const char* statements :
       {"x = 1", "x += 1", "x++", "l.append(1)", "l.remove(x)", "s << 1 << \"a\"", "stop", "return",
        "f(1, 2)", "m.target.x = a[1][2]", "for i = 0, 3:\n            x = i\n            break",
        "for a, b in l:\n            continue",
        "atomic:\n            x = 1\n            atomic:\n                y = 1",
        "if x:\n            y = 1\n        elif z:\n            y = 2\n        else:\n            y = 3",
        "if x:\n            y = 1\n        else:\n            if z:\n                y = 2",
        "x = any q in [1, 2]\n        y = any int in 0..5"})
    ExpectSafe(Event(statements));
}

TEST(Format, SpecificationsKeepTheirMeaning) {
  for (const char* line : {"param float limit", "param pos a = pos(1, 2)", "assume limit > 0",
                           "assume named: limit > 0", "assume initially: M.at in rect(a, b)",
                           "assume M always M.at > 0", "assume M.calm when M.to > 0 always M.at >= old(M.at)",
                           "summary f(a, b) -> y: y >= a", "summary M.way(a) -> y: y > 0", "invariant: true",
                           "invariant one: forall i, j in ID: x[i] == x[j] implies i == j",
                           "platform M = Car from \"car.rondo\" every 0.1",
                           "explore:\n    N_sys = 3\n    M.at in [1, 2]\n    f(a) = a + 1"})
    ExpectSafe(Event("stop") + line + "\n");
}

TEST(Format, DeclarationsKeepTheirMeaning) {
  for (const char* declaration :
       {"agent Walker", "def adt Task:\n    int id\n    pos at[2][N_sys]", "def stage {pick, go}",
        "def fun f(int a, List<int> b) -> bool", "def fun f(pos p) -> pos:\n    return p",
        "using M:\n    sensors:\n        pos at\n    actuators:\n        pos to",
        "allread:\n    pos x[N_sys]", "allwrite:\n    List<pos, int> l\n    int[3] a",
        "local:\n    bool b = not true\n    enum {on, off} mode = on", "init:\n    x = 1"})
    ExpectSafe(std::string(declaration) + "\n" + Event("stop"));
}

TEST(Format, BracketsStayWhereTheyMatter) {
  for (const char* expression :
       {"(a + b) * c", "a - (b - c)", "a / (b * c)", "-(a + b)", "not (a and b)", "(a or b) and c",
        "(a implies b) implies c", "(not a) == b", "(a == b) == c", "(forall i in ID: x[i]) and b",
        "forall i in ID: x[i] and b", "(a + b).x", "(a in b) == c", "- -a", "a - -b", "not not a"})
    ExpectSafe(Event(std::string("x = ") + expression));
}

TEST(Format, SuperfluousBracketsGo) {
  EXPECT_EQ(Canonical(Event("x = ((a * b)) + (c)")), Event("x = a * b + c"));
  EXPECT_EQ(Canonical(Event("x = (a and b) or (not c)")), Event("x = a and b or not c"));
}

TEST(Format, CommentsStayWhereTheyStand) {
  const std::string text =
      "# of the file\n\n# of the section\nlocal:  # behind it\n    # above n\n    int n  # behind n\n\nE:\n    # above pre\n    pre: n > 0  # of pre\n"
      "    eff:\n        # above\n        n = 1  # behind\n# at the end\n";
  ExpectSafe(text);
  EXPECT_EQ(Canonical(text), text);
}

TEST(Format, NoCommentIsLost) {
  for (
      const char* text :
      {"E:  # a\n    eff:  # b\n        # c\n        stop\n        # d\n",
       "E:\n    eff:\n        if x:  # a\n            stop\n        # b\n        else:  # c\n            stop\n",
       "local:\n    int n = max(1,  # a\n        2)  # b\nE:\n    eff:\n        stop\n",
       "// a\nE: // b\n    eff: stop // c\n",
       "E:\n    eff:\n        stop\nexplore:\n    # a\n    p = 1  # b\n    # c\n",
       "#\n#  two\nE:\n    eff:\n        stop\n",
       "E:\n    eff:\n        stop\nassume M when a  # a\n    always b  # b\n",
       "def stage {a, b}  # a\nE:\n    eff:\n        atomic:  # b\n            stop  # c\n"})
    ExpectSafe(text);
}

TEST(Format, AnEmptyCommentHasNoBlank) { EXPECT_EQ(Canonical("#\n" + Event("stop")), "#\n" + Event("stop")); }

TEST(Format, DialectsBecomeOne) {
  EXPECT_EQ(Canonical("E:\n    pre (!a && b || c)\n    eff: x = 1\n"),
            "E:\n    pre: not a and b or c\n    eff:\n        x = 1\n");
  EXPECT_EQ(Canonical("E:\n  pre a = b\n  eff: atomic:\n    x = True\n"),
            "E:\n    pre: a == b\n    eff:\n        atomic:\n            x = true\n");
  EXPECT_EQ(Canonical("using module M\n  sensors: pos at\n" + Event("stop")),
            "using M:\n    sensors:\n        pos at\n\n" + Event("stop"));
  EXPECT_EQ(Canonical("local: int n\r\nE:\r\n\teff: stop\r\n"), "local:\n    int n\n\n" + Event("stop"));
}

TEST(Format, NamesAreKeptAsWritten) {
  const std::string text = "local:\n    boolean b\n    Point p\n\n" + Event("x = numAgents + N_sys");
  EXPECT_EQ(Canonical(text), text);
}

TEST(Format, AnElseWithAnIfIsNoElif) {
  const std::string nested =
      Event("if a:\n            stop\n        else:\n            if b:\n                stop");
  const std::string chained = Event("if a:\n            stop\n        elif b:\n            stop");
  EXPECT_EQ(Canonical(nested), nested);
  EXPECT_EQ(Canonical(chained), chained);
}

TEST(Format, SectionsStandApartAndSpecificationsTogether) {
  EXPECT_EQ(
      Canonical(
          "local:\n    int n\nE:\n    eff:\n        stop\nparam int p\nassume p > 0\n\ninvariant: n > 0\n"),
      "local:\n    int n\n\n" + Event("stop") + "\nparam int p\nassume p > 0\n\ninvariant: n > 0\n");
}

TEST(Format, LongSpecificationsGoOnInTheNextLine) {
  const std::string sum =
      "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa[i] + bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb[i] + cccccccccccccccccccccccc[i] > 0";
  const std::string text = Event("stop") + "\ninvariant long: forall i in ID: " + sum + "\n";
  ExpectSafe(text);
  EXPECT_EQ(Canonical(text), Event("stop") + "\ninvariant long: forall i in ID:\n    " + sum + "\n");
  ExpectSafe(Event("stop") + "assume M always " + sum + "\n");
  ExpectSafe(Event("stop") + "summary f(a) -> y: " + sum + "\n");
}

TEST(Format, AConditionHasALineOfItsOwn) {
  EXPECT_EQ(Canonical(Event("stop") + "assume M.calm when a > 0 always b > 0\n"),
            Event("stop") + "\nassume M.calm when a > 0\n    always b > 0\n");
}

TEST(Skeletons, CommentsAndBlankLinesDoNotCount) {
  const Parsed plain("local:\n    int n\nE:\n    eff:\n        n = 1\n");
  const Parsed written("# a\n\nlocal:\n\n    int n  # b\n\n\nE:\n  eff: n = (1)\n");
  EXPECT_EQ(Skeleton(plain.program), Skeleton(written.program));
}

TEST(Skeletons, EveryPartCounts) {
  const auto skeleton = [](const std::string& text) { return Skeleton(Parsed(text).program); };
  const std::string text = "local:\n    int n = 1\n\nE:\n    pre: a\n    eff:\n        n = 1\n";
  for (const char* other : {"local:\n    int n\nE:\n    pre: a\n    eff:\n        n = 1\n",
                            "local:\n    int n = 1\nF:\n    pre: a\n    eff:\n        n = 1\n",
                            "local:\n    int n = 1\nE:\n    pre urgent: a\n    eff:\n        n = 1\n",
                            "local:\n    int n = 1\nE:\n    eff:\n        n = 1\n",
                            "local:\n    int n = 1\nE:\n    pre: a\n    eff:\n        n += 1\n",
                            "allwrite:\n    int n = 1\nE:\n    pre: a\n    eff:\n        n = 1\n",
                            "local:\n    float n = 1\nE:\n    pre: a\n    eff:\n        n = 1\n"})
    EXPECT_NE(skeleton(text), skeleton(other)) << other;
}

TEST(Format, AnEmptyCommentLeavesNoBlankBehindIt) {
  EXPECT_EQ(Canonical("E:\n    eff:\n        stop  #\n"), "E:\n    eff:\n        stop  #\n");
}

}  // namespace
}  // namespace rondo::koord
