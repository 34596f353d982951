// What names mean and which types fit, each rule with what it accepts and a small change that it rejects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/check/spec_labels.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

using diag::Kind;
using testing::ElementsAre;
using testing::IsEmpty;

class Typing : public testing::Test {
 protected:
  void Load(const std::string& text) {
    diagnostics_ = {};
    program_ = {};
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
  }
  std::vector<Kind> Reports(const std::string& text) {
    Load(text);
    std::vector<Kind> kinds;
    for (const diag::Diagnostic& d : diagnostics_.all()) kinds.push_back(d.kind);
    return kinds;
  }
  /// What is reported of a statement about variables of several types.
  std::vector<Kind> Event(const std::string& statement) {
    return Reports(
        "def stage {pick, go}\ndef adt Task:\n    int id\n    pos at\n"
        "def fun f(int k, float y) -> float\n"
        "local:\n    int n\n    float x\n    bool b\n    string t\n    pos p\n    stage g\n    Task task\n"
        "    List<int> l\n    List<pos, int> pairs\n    int a[3]\n    int a2[2][3]\n    int other[4]\n    Motor m\n"
        "E:\n    eff:\n        " +
        statement + "\n");
  }
  void Accepts(std::initializer_list<const char*> statements) {
    for (const char* s : statements) EXPECT_THAT(Event(s), IsEmpty()) << s;
  }
  void Rejects(Kind kind, std::initializer_list<const char*> statements) {
    for (const char* s : statements) EXPECT_THAT(Event(s), ElementsAre(kind)) << s;
  }
  /// The type of the first variable.
  std::string TypeOf(const std::string& declaration) {
    Load("local:\n    " + declaration + "\nE:\n    eff:\n        stop\n");
    return model_.types.Name(model_.variables.at(0).type);
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
};

TEST_F(Typing, AnIntBecomesAFloatButNotBack) {
  Accepts({"x = n", "x = 1", "x = n + x", "x = f(n, n)"});
  Rejects(Kind::kKoordTypeMismatch, {"n = x", "n = 1.5", "n = n + x", "x = f(x, x)"});
}

TEST_F(Typing, ARemainderIsOfInts) {
  Accepts({"n = n % 2", "n = n / 2", "x = x / 2"});
  Rejects(Kind::kKoordTypeMismatch, {"x = x % 2", "x = n % 2.0", "n = n / 2.0"});
}

TEST_F(Typing, PointsAreAddedAndScaled) {
  Accepts({"p = p + p", "p = p - p", "p = 2 * p", "p = p * x", "p = p / n", "p = -p", "p += p", "x = p.y"});
  Rejects(Kind::kKoordTypeMismatch, {"p = p + 1", "p = p * p", "p = 2 / p", "p++", "p = x"});
}

TEST_F(Typing, ConditionsAreTrueOrFalse) {
  Accepts({"if b:\n            n = 1", "b = b and n == 1", "b = not b", "b = b implies n > 0"});
  Rejects(Kind::kKoordNotBoolean,
          {"if n:\n            n = 1", "b = b and n", "b = not n", "b = x implies b"});
}

TEST_F(Typing, ComparisonsAreOfOneType) {
  Accepts({"b = n < x", "b = p == p", "b = g == go", "b = t == \"a\"", "b = l == [1]", "b = a == a",
           "b = m == m"});
  Rejects(Kind::kKoordTypeMismatch,
          {"b = n == b", "b = p < p", "b = g < go", "b = t == 1", "b = g == n", "b = a == other"});
}

TEST_F(Typing, MembershipNeedsASetOfThatType) {
  Accepts({"b = n in l", "b = n in ID", "b = p in rect(p, p)", "b = n not in [1, 2]"});
  Rejects(Kind::kKoordTypeMismatch,
          {"b = p in l", "b = x in ID", "b = n in rect(p, p)", "b = p in rect(p, n)", "b = n in n"});
}

TEST_F(Typing, AnIndexIsAnIntOfSomethingWithItems) {
  Accepts({"n = a[n]", "n = l[0]", "n = a2[1][2]", "a2[0] = a"});
  Rejects(Kind::kKoordTypeMismatch, {"n = a[x]", "n = l[b]", "n = a2[0]", "a2[0] = other"});
  Rejects(Kind::kKoordNotIndexable, {"n = n[0]", "n = a[0][0]", "x = p[0]"});
}

TEST_F(Typing, ItemsOfAListHaveOneType) {
  Accepts({"l = [1, 2]", "l = []", "l.append(n)", "l.remove(3)", "n = len(l)"});
  Rejects(Kind::kKoordTypeMismatch, {"l = [1, b]", "l.append(p)", "n.append(1)", "n = len(n)", "n = len(a)"});
  Rejects(Kind::kKoordNotCallable, {"l.drop(1)"});
}

TEST_F(Typing, LoopsRunOverListsAndRangesOfInts) {
  Accepts({"for i in l:\n            n = i", "for i in a:\n            n = i",
           "for i = 0, n:\n            n = i"});
  Accepts({"for q, k in pairs:\n            n = k"});
  Rejects(Kind::kKoordTypeMismatch, {"for i in n:\n            n = 1", "for i = 0, x:\n            n = i",
                                     "for i = b, 1:\n            n = i"});
  Rejects(Kind::kKoordArity,
          {"for q, k, r in pairs:\n            n = 1", "for q, k in l:\n            n = 1"});
}

TEST_F(Typing, CallsHaveTheirArguments) {
  Accepts({"x = f(1, 2)", "x = min(n, x, 3)", "n = max(n, 1)", "n = abs(n)", "p = pos(1, 2)", "p = mid(p, p)",
           "x = dist(p, p)"});
  Rejects(Kind::kKoordArity, {"x = f(1)", "x = f(1, 2, 3)", "x = min(n)", "n = min(n)", "x = abs(n, n)",
                              "n = abs(n, n)", "p = pos(1)", "x = dist(p)"});
  Rejects(Kind::kKoordTypeMismatch,
          {"x = f(p, 1)", "n = max(n, x)", "p = pos(b, 1)", "x = dist(p, 1)", "p = mid(1, 2)"});
}

TEST_F(Typing, OnlyFunctionsAreCalled) { Rejects(Kind::kKoordNotCallable, {"n = n(1)"}); }

TEST_F(Typing, MembersExist) {
  Accepts({"n = task.id", "x = task.at.z", "n = m.speed"});
  Rejects(Kind::kKoordUnknownMember, {"n = task.nr", "x = p.w", "n = n.x"});
}

TEST_F(Typing, NamesAreDeclared) {
  Rejects(Kind::kKoordUndeclared, {"n = k", "k = n", "g = stay", "n = Motion.at"});
  Rejects(Kind::kKoordUnknownFunction, {"n = h(n)"});
}

TEST_F(Typing, AVariableOfALoopEndsWithIt) {
  Accepts({"for i = 0, 3:\n            n = i"});
  Rejects(Kind::kKoordUndeclared, {"for i = 0, 3:\n            n = 1\n        n = i"});
}

TEST_F(Typing, AnInnerNameHidesAnOuterOne) {
  Accepts({"for b = 0, 3:\n            n = b"});
  Rejects(Kind::kKoordTypeMismatch, {"for x in [p]:\n            n = x"});
}

TEST_F(Typing, APortOfTwoModulesNeedsItsModule) {
  const std::string head =
      "using L:\n    sensors:\n        int at\nusing R:\n    sensors:\n        int at\nlocal:\n    int n\nE:\n    eff:\n";
  EXPECT_THAT(Reports(head + "        n = L.at + R.at\n"), IsEmpty());
  EXPECT_THAT(Reports(head + "        n = at\n"), ElementsAre(Kind::kKoordAmbiguousPort));
}

TEST_F(Typing, NamesAreDeclaredOnce) {
  const std::string tail = "E:\n    eff:\n        stop\n";
  EXPECT_THAT(Reports("local:\n    int E\n" + tail), IsEmpty());
  EXPECT_THAT(Reports("local:\n    int a\n    int a\n" + tail), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(Reports("def stage {a, b}\nlocal:\n    int a\n" + tail), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(Reports("def fun f(int k, int k) -> int\n" + tail), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(Reports("def adt T:\n    int k\n    int k\n" + tail), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(Reports(tail + tail), ElementsAre(Kind::kKoordDuplicate));
  EXPECT_THAT(Reports(tail + "invariant i: true\ninvariant i: true\n"), ElementsAre(Kind::kKoordDuplicate));
}

TEST_F(Typing, LengthsOfArraysNeverChange) {
  const auto length = [&](const std::string& text) {
    return Reports("param int p\nallwrite:\n    int n\n    int a[" + text +
                   "]\nE:\n    eff:\n        stop\n");
  };
  for (const char* fixed : {"1", "p", "N_sys", "2 * p + N_sys"})
    EXPECT_THAT(length(fixed), IsEmpty()) << fixed;
  for (const char* bad : {"0", "n", "p / 2"})
    EXPECT_THAT(length(bad), ElementsAre(Kind::kKoordArrayLength)) << bad;
  EXPECT_THAT(length("1.5"), testing::Contains(Kind::kKoordTypeMismatch));
}

TEST_F(Typing, NamesOfTypesMayDiffer) {
  for (const char* type : {"bool", "boolean"}) EXPECT_EQ(TypeOf(std::string(type) + " v"), "bool");
  for (const char* type : {"pos", "Point", "Position"}) EXPECT_EQ(TypeOf(std::string(type) + " v"), "pos");
  EXPECT_EQ(TypeOf("Queue<int> v"), TypeOf("List<int> v"));
  EXPECT_EQ(TypeOf("Gadget v"), "Gadget");
  EXPECT_THAT(Reports("local:\n    gadget v\nE:\n    eff:\n        stop\n"),
              ElementsAre(Kind::kKoordUnknownType));
}

TEST_F(Typing, AnAllreadVariableIsOneCellForEachRobot) {
  for (const char* declaration : {"int x[N_sys]", "int[] x", "int x"}) {
    EXPECT_THAT(
        Reports(std::string("allread:\n    ") + declaration + "\nE:\n    eff:\n        x[pid] = x[0]\n"),
        IsEmpty());
    EXPECT_EQ(model_.types.Name(model_.variables[0].type), "int");
  }
}

TEST_F(Typing, ARecordDoesNotContainItself) {
  const std::string tail = "E:\n    eff:\n        stop\n";
  EXPECT_THAT(Reports("def adt Tree:\n    List<Tree> below\n" + tail), IsEmpty());
  EXPECT_THAT(Reports("def adt Tree:\n    Tree below\n" + tail), ElementsAre(Kind::kKoordTypeMismatch));
}

TEST_F(Typing, AProgramHasAnEvent) {
  EXPECT_THAT(Reports("local:\n    int n\n"), ElementsAre(Kind::kKoordNoEvent));
}

TEST_F(Typing, SectionsInAnotherOrderAreAWarning) {
  EXPECT_THAT(Reports("E:\n    eff:\n        stop\nlocal:\n    int n\n"),
              ElementsAre(Kind::kKoordSectionOrder));
  EXPECT_FALSE(diagnostics_.has_errors());
  EXPECT_THAT(Reports("invariant: true\nE:\n    eff:\n        stop\n"), IsEmpty());
}

TEST_F(Typing, UsesTellWhatAFunctionTakes) {
  const std::string head = "local:\n    int n\n    pos p\nE:\n    eff:\n        n = h(n, p)\n";
  EXPECT_THAT(Reports(head + "summary h(k, q) -> y: y > k\n"), IsEmpty());
  EXPECT_THAT(Reports(head + "        n = h(n)\nsummary h(k, q) -> y: y > k\n"),
              ElementsAre(Kind::kKoordArity));
  EXPECT_THAT(Reports(head + "        n = h(p, p)\nsummary h(k, q) -> y: y > k\n"),
              ElementsAre(Kind::kKoordTypeMismatch));
}

TEST_F(Typing, FunctionsReturnTheirType) {
  const std::string tail = "local:\n    int n\nE:\n    eff:\n        n = 0\n";
  EXPECT_THAT(Reports("def fun h(int k) -> float:\n    return k\n" + tail), IsEmpty());
  EXPECT_THAT(Reports("def fun h(float k) -> int:\n    return k\n" + tail),
              ElementsAre(Kind::kKoordTypeMismatch));
}

TEST_F(Typing, UnnamedInvariantsAvoidNamesThatAreTaken) {
  Load("E:\n    eff:\n        stop\ninvariant: true\ninvariant b: true\ninvariant invariant1: true\n");
  EXPECT_EQ(InvariantName(model_, 1), "b");
  EXPECT_EQ(InvariantName(model_, 2), "invariant1");
  EXPECT_NE(InvariantName(model_, 0), InvariantName(model_, 2));
}

TEST_F(Typing, UnnamedAssumptionsOfAModuleAreNumbered) {
  Load(
      "using M:\n    sensors:\n        int at\nE:\n    eff:\n        stop\nassume M always M.at > 0\n"
      "assume M.low always M.at < 9\nassume M always M.at != 5\n");
  EXPECT_EQ(AssumptionName(model_, *model_.assumptions[0]), "M (1)");
  EXPECT_EQ(AssumptionName(model_, *model_.assumptions[1]), "M.low");
  EXPECT_EQ(AssumptionName(model_, *model_.assumptions[2]), "M (2)");
}

TEST_F(Typing, AssumptionsWithoutConditionOrOldHoldAlways) {
  Load(
      "using M:\n    sensors:\n        int at\nE:\n    eff:\n        stop\nassume M always M.at > 0\n"
      "assume M when M.at > 0 always M.at > 0\nassume M always M.at > old(M.at)\n");
  EXPECT_TRUE(HoldsAlways(model_, *model_.assumptions[0]));
  EXPECT_FALSE(HoldsAlways(model_, *model_.assumptions[1]));
  EXPECT_FALSE(HoldsAlways(model_, *model_.assumptions[2]));
}

}  // namespace
}  // namespace rondo::koord
