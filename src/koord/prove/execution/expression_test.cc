// Expressions as terms: what docs/language.md says of operators, built-in functions and quantifiers.
#include <gtest/gtest.h>

#include "expr/evaluate.h"
#include "koord/check/check.h"
#include "koord/prove/execution/executor.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

// Invariants of one program, evaluated for robot 1 of three; `k` is -7.
class Expressions : public testing::Test {
 protected:
  void Load(const std::string& text) {
    const std::string all =
        "allwrite:\n    int a[3]\nlocal:\n    int k\nE:\n    eff:\n        k = 0\n" + text;
    Parse(sources_, sources_.Add("test.koord", all), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
    vocabulary_.emplace(arena_, model_, 3);
    view_ = vocabulary_->MakeView("");
    view_.value[1] = arena_.Store(view_.value[1], arena_.IntNumber(1), arena_.IntNumber(-7));
  }
  TermId Term(Executor& executor, const View* old = nullptr) {
    return executor.Specification(model_.invariants[0]->body, view_, arena_.IntNumber(1), old, {});
  }
  std::string Text(TermId term) const {
    const auto value = Evaluate(arena_, term, [](TermId) { return std::optional<expr::Value>(); });
    return value ? ToString(*value) : "none";
  }
  /// The truth value of a formula.
  std::string Truth(const std::string& formula) {
    program_ = {};
    Load("invariant: " + formula + "\n");
    Executor executor(*vocabulary_, diagnostics_, {.expand_robots = true});
    return Text(Term(executor));
  }
  /// The operations of the formula that are reached and undefined.
  size_t Undefined(const std::string& formula) {
    program_ = {};
    Load("invariant: " + formula + "\n");
    Executor executor(*vocabulary_, diagnostics_, {.expand_robots = true});
    Term(executor);
    size_t count = 0;
    for (const DefinednessCheck& c : executor.TakeSpecificationChecks())
      count += Text(c.reached) == "true" && Text(c.holds) == "false" ? 1 : 0;
    return count;
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  expr::Arena arena_;
  std::optional<Vocabulary> vocabulary_;
  View view_;
};

TEST_F(Expressions, DivisionOfIntsIsEuclidean) {
  EXPECT_EQ(Truth("k / 2 == -4 and k % 2 == 1"), "true");
  EXPECT_EQ(Truth("k / (0 - 2) == 4 and k % (0 - 2) == 1"), "true");
}

TEST_F(Expressions, DivisionOfFloatsIsExact) {
  EXPECT_EQ(Truth("k / 2.0 == -3.5"), "true");
  EXPECT_EQ(Truth("(k + 8.0) / 3 * 3 == 1"), "true");
}

TEST_F(Expressions, ComparisonsHaveTheirEdges) {
  EXPECT_EQ(Truth("k < -7"), "false");
  EXPECT_EQ(Truth("k <= -7"), "true");
  EXPECT_EQ(Truth("k > -7"), "false");
  EXPECT_EQ(Truth("k >= -7"), "true");
  EXPECT_EQ(Truth("k == -7.0"), "true");
  EXPECT_EQ(Truth("k != -7"), "false");
}

TEST_F(Expressions, ImpliesBindsWeakest) {
  EXPECT_EQ(Truth("false implies false and false"), "true");
  EXPECT_EQ(Truth("true or true implies false"), "false");
  EXPECT_EQ(Truth("not false and false or true"), "true");
}

TEST_F(Expressions, BuiltInFunctionsOfNumbers) {
  EXPECT_EQ(Truth("abs(k) == 7 and abs(7) == 7"), "true");
  EXPECT_EQ(Truth("min(3, k, 5) == -7 and min(k, 3, 5) == -7"), "true");
  EXPECT_EQ(Truth("max(3, k, 5) == 5 and max(5, k, 3) == 5"), "true");
  EXPECT_EQ(Truth("dist(k, 3) == 10 and dist(3, k) == 10"), "true");
  EXPECT_EQ(Truth("mid(k, 2) == -2.5"), "true");
}

TEST_F(Expressions, PointsAreCalculatedByCoordinate) {
  EXPECT_EQ(Truth("pos(1, 2, 3) + pos(1, 1, 1) == pos(2, 3, 4)"), "true");
  EXPECT_EQ(Truth("pos(1, 2, 3) - pos(3, 2, 1) == pos(-2, 0, 2)"), "true");
  EXPECT_EQ(Truth("2 * pos(1, 2, 3) == pos(1, 2, 3) * 2"), "true");
  EXPECT_EQ(Truth("pos(1, 2, 3) / 2 == pos(0.5, 1, 1.5)"), "true");
  EXPECT_EQ(Truth("-pos(1, 2, 3) == pos(-1, -2, -3)"), "true");
  EXPECT_EQ(Truth("mid(pos(1, 2, 3), pos(3, 2, 2)) == pos(2, 2, 2.5)"), "true");
}

TEST_F(Expressions, PointsDifferIfOneCoordinateDoes) {
  EXPECT_EQ(Truth("pos(1, 2, 3) == pos(1, 2, 4)"), "false");
  EXPECT_EQ(Truth("pos(1, 2) == pos(1, 2, 0)"), "true");
  EXPECT_EQ(Truth("pos(1, 2).y == 2 and pos(1, 2).z == 0"), "true");
}

TEST_F(Expressions, ARectangleHasItsBorders) {
  EXPECT_EQ(Truth("pos(1, 1, 1) in rect(pos(1, 1, 1), pos(2, 2, 2))"), "true");
  EXPECT_EQ(Truth("pos(2, 2, 2) in rect(pos(1, 1, 1), pos(2, 2, 2))"), "true");
  EXPECT_EQ(Truth("pos(1, 1, 2.1) in rect(pos(1, 1, 1), pos(2, 2, 2))"), "false");
  EXPECT_EQ(Truth("pos(1, 0.9, 1) in rect(pos(1, 1, 1), pos(2, 2, 2))"), "false");
  EXPECT_EQ(Truth("pos(0, 1, 1) not in rect(pos(1, 1, 1), pos(2, 2, 2))"), "true");
}

TEST_F(Expressions, RobotsAreNumberedFromZero) {
  EXPECT_EQ(Truth("0 in ID and 2 in ID"), "true");
  EXPECT_EQ(Truth("3 in ID or k in ID"), "false");
  EXPECT_EQ(Truth("N_sys == 3 and pid == 1"), "true");
}

TEST_F(Expressions, QuantifiersOverRobotsMeetEachOfThem) {
  EXPECT_EQ(Truth("forall i in ID: i >= 0 and i <= 2"), "true");
  EXPECT_EQ(Truth("forall i in ID: i < 2"), "false");
  EXPECT_EQ(Truth("exists i in ID: i == 2"), "true");
  EXPECT_EQ(Truth("exists i in ID: i == 3"), "false");
  EXPECT_EQ(Truth("forall i in ID: exists j in ID: j == (i + 1) % N_sys"), "true");
  EXPECT_EQ(Truth("exists j in ID: forall i in ID: j == (i + 1) % N_sys"), "false");
}

TEST_F(Expressions, LengthsAndItemsOfLists) {
  EXPECT_EQ(Truth("len([4, 5, 6]) == 3 and [4, 5, 6][2] == 6"), "true");
  EXPECT_EQ(Truth("[1, 2.5][0] == 1"), "true");
}

TEST_F(Expressions, AnIndexIsFromZeroBelowTheLength) {
  EXPECT_EQ(Undefined("a[0] == 0 and [1, 2][1] == 0"), 0U);
  EXPECT_EQ(Undefined("a[3] == 0"), 1U);
  EXPECT_EQ(Undefined("a[k] == 0"), 1U);
  EXPECT_EQ(Undefined("[1, 2][2] == 0"), 1U);
}

TEST_F(Expressions, ADivisorIsNotZero) {
  EXPECT_EQ(Undefined("1 / (k + 7) == 0"), 1U);
  EXPECT_EQ(Undefined("1 % (k + 7) == 0"), 1U);
  EXPECT_EQ(Undefined("1.5 / (k + 7.0) == 0"), 1U);
  EXPECT_EQ(Undefined("pos(1, 1) / (k + 7) == pos(0, 0)"), 1U);
  EXPECT_EQ(Undefined("1 / (k + 8) == 0"), 0U);
}

TEST_F(Expressions, OnlyWhatIsReachedMustBeDefined) {
  EXPECT_EQ(Undefined("k > 0 and a[k] == 0"), 0U);
  EXPECT_EQ(Undefined("k < 0 and a[k] == 0"), 1U);
  EXPECT_EQ(Undefined("k < 0 or a[k] == 0"), 0U);
  EXPECT_EQ(Undefined("k > 0 or a[k] == 0"), 1U);
  EXPECT_EQ(Undefined("k > 0 implies a[k] == 0"), 0U);
  EXPECT_EQ(Undefined("k < 0 implies a[k] == 0"), 1U);
}

TEST_F(Expressions, AnotherRobotMustExist) {
  EXPECT_EQ(Undefined("k[2] == 0"), 0U);
  EXPECT_EQ(Undefined("k[3] == 0"), 1U);
  EXPECT_EQ(Undefined("k[-1] == 0"), 1U);
}

TEST_F(Expressions, ANameWithoutARobotSpeaksOfEach) {
  Load("invariant: k == 0\n");
  Executor executor(*vocabulary_, diagnostics_);
  Term(executor);
  EXPECT_TRUE(executor.used_robot());
}

TEST_F(Expressions, ANameWithARobotSpeaksOfThatOne) {
  Load("invariant: forall i in ID: k[i] == 0\n");
  Executor executor(*vocabulary_, diagnostics_);
  Term(executor);
  EXPECT_FALSE(executor.used_robot());
}

TEST_F(Expressions, ArraysAreEqualWhereTheyHaveItems) {
  Load("allwrite:\n    int b[3]\ninvariant: a == b\n");
  const auto array = [&](const std::vector<int64_t>& items) {
    TermId whole = arena_.FreshConstant("array", arena_.Array(arena_.Int(), arena_.Int()));
    for (size_t i = 0; i < items.size(); ++i)
      whole = arena_.Store(whole, arena_.IntNumber(static_cast<int64_t>(i)), arena_.IntNumber(items[i]));
    return whole;
  };
  for (const auto& [last, equal] : {std::pair(6, "true"), {7, "false"}}) {
    view_.value[0] = array({4, 5, 6});
    view_.value[2] = array({4, 5, last, last});
    Executor executor(*vocabulary_, diagnostics_);
    EXPECT_EQ(Text(Term(executor)), equal);
  }
}

TEST_F(Expressions, FunctionsAreExecutedOnTheirArguments) {
  Load(
      "def fun sign(int n) -> int:\n    if n < 0:\n        return -1\n    if n == 0:\n        return 0\n    return 1\n"
      "def fun total(int n) -> int:\n    for i = 0, 3:\n        n += i\n    return n\n"
      "invariant: sign(k) == -1 and sign(0) == 0 and sign(9) == 1 and total(k) == k + 3\n");
  Executor executor(*vocabulary_, diagnostics_);
  EXPECT_EQ(Text(Term(executor)), "true");
}

TEST_F(Expressions, AFunctionWithoutReturnHasSomeValueEachTime) {
  Load("def fun maybe(int n) -> int:\n    if n > 0:\n        return n\ninvariant: maybe(k) == maybe(k)\n");
  Executor executor(*vocabulary_, diagnostics_);
  EXPECT_EQ(Text(Term(executor)), "none");
  bool missing = false;
  for (const DefinednessCheck& c : executor.TakeSpecificationChecks())
    missing = missing || (c.kind == CheckKind::kReturn && Text(c.holds) == "false");
  EXPECT_TRUE(missing);
}

TEST_F(Expressions, OldIsTheOtherMoment) {
  Load(
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\n"
      "assume M when M.to > 0 always M.at == old(M.at) + 1\n");
  const View old = vocabulary_->MakeView(" before");
  Executor executor(*vocabulary_, diagnostics_);
  const TermId robot = arena_.IntNumber(1);
  const TermId promise = executor.Specification(model_.assumptions[0]->body, view_, robot, &old, {});
  size_t at = 0;
  while (model_.variables[at].name != "M.at") ++at;
  const TermId before = arena_.Select(old.value[at], robot);
  const TermId after = arena_.Select(view_.value[at], robot);
  const auto value = Evaluate(arena_, promise, [&](TermId leaf) -> std::optional<expr::Value> {
    if (leaf == before) return expr::Value{expr::Rational(4)};
    if (leaf == after) return expr::Value{expr::Rational(5)};
    return std::nullopt;
  });
  ASSERT_TRUE(value.has_value());
  EXPECT_TRUE(value->AsBool());
}

TEST_F(Expressions, TextsAreMarked) {
  Load("local:\n    string s\ninvariant: s == \"a\"\n");
  Executor executor(*vocabulary_, diagnostics_);
  EXPECT_FALSE(vocabulary_->uses_texts());
  Term(executor);
  EXPECT_TRUE(vocabulary_->uses_texts());
}

TEST_F(Expressions, AnInitialValueThatMayBeUndefinedIsReported) {
  Load("param int p\nlocal:\n    int good = p + 1\n    int bad = 1 / p\n");
  Executor executor(*vocabulary_, diagnostics_);
  for (const Variable& v : model_.variables) {
    if (!v.initial.valid()) continue;
    executor.Value(v.initial, v.type, view_, arena_.IntNumber(1));
    EXPECT_EQ(diagnostics_.errors(), v.name == "bad" ? 1U : 0U);
  }
}

}  // namespace
}  // namespace rondo::koord
