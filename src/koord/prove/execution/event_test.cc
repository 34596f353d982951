// What one robot's event leaves, executed symbolically on given values.
#include <gtest/gtest.h>

#include "expr/evaluate.h"
#include "koord/check/check.h"
#include "koord/prove/execution/executor.h"
#include "koord/syntax/parser.h"

namespace rondo::koord {
namespace {

class EventExecution : public testing::Test {
 protected:
  static constexpr int64_t kRobots = 3;
  static constexpr int64_t kSelf = 1;

  void Load(const std::string& text) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
    vocabulary_.emplace(arena_, model_, kRobots);
    start_ = vocabulary_->MakeView("");
  }
  size_t Find(const std::string& name) const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].name == name) return v;
    }
    ADD_FAILURE() << "no variable " << name;
    return 0;
  }
  TermId Int(int64_t value) { return arena_.IntNumber(value); }
  void Give(const std::string& name, TermId value, int64_t robot = kSelf) {
    TermId& whole = start_.value[Find(name)];
    whole = model_.variables[Find(name)].PerRobot() ? arena_.Store(whole, Int(robot), value) : value;
  }
  void Give(const std::string& name, int64_t value, int64_t robot = kSelf) { Give(name, Int(value), robot); }
  void Run(ExecutionOptions options = {}) {
    Executor executor(*vocabulary_, diagnostics_, options);
    start_.stopped = arena_.Store(start_.stopped, Int(kSelf), arena_.False());
    effect_ = executor.Run(*model_.events[0], start_, Int(kSelf));
  }
  std::string Text(TermId term) const {
    const auto value = Evaluate(arena_, term, [&](TermId leaf) -> std::optional<expr::Value> {
      const bool choice = arena_.op(leaf) == expr::Op::kApply &&
                          arena_.symbol(arena_.symbol_of(leaf)).name.starts_with("choice");
      if (choice) return expr::Value{expr::Rational(choice_)};
      if (arena_.op(leaf) == expr::Op::kListLength) return expr::Value{expr::Rational(length_)};
      return std::nullopt;
    });
    return value ? ToString(*value) : "none";
  }
  std::string After(const std::string& name) const { return Text(effect_.value[Find(name)]); }
  std::string After(const std::string& name, int64_t index) {
    return Text(arena_.Select(effect_.value[Find(name)], Int(index)));
  }
  /// How many operations of this kind are reached and undefined.
  size_t Undefined(CheckKind kind) const {
    size_t count = 0;
    for (const DefinednessCheck& c : effect_.checks) {
      if (c.kind == kind && Text(c.reached) == "true" && Text(c.holds) == "false") ++count;
    }
    return count;
  }
  /// How many writes of shared variables happen.
  size_t Writes() const {
    size_t count = 0;
    for (const SharedWrite& w : effect_.writes) count += Text(w.condition) == "true" ? 1 : 0;
    return count;
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  expr::Arena arena_;
  std::optional<Vocabulary> vocabulary_;
  View start_;
  Effect effect_;
  int64_t choice_ = 0;
  int64_t length_ = 0;
};

TEST_F(EventExecution, TheGuardLooksAtTheStart) {
  Load("local:\n    int n\nE:\n    pre: n > 3\n    eff:\n        n = 0\n");
  Give("n", 4);
  Run();
  EXPECT_EQ(Text(effect_.enabled), "true");
  Give("n", 3);
  Run();
  EXPECT_EQ(Text(effect_.enabled), "false");
}

TEST_F(EventExecution, AStoppedRobotRunsNoEvent) {
  Load("local:\n    int n\nE:\n    eff:\n        if n > 0:\n            stop\n");
  Executor executor(*vocabulary_, diagnostics_);
  for (const bool stopped : {true, false}) {
    start_.stopped = arena_.Store(start_.stopped, Int(kSelf), arena_.Constant(stopped));
    effect_ = executor.Run(*model_.events[0], start_, Int(kSelf));
    EXPECT_EQ(Text(effect_.enabled), stopped ? "false" : "true");
  }
}

TEST_F(EventExecution, StatementsSeeTheRobotsOwnEarlierWrites) {
  Load("local:\n    int n\n    int m\nE:\n    eff:\n        m = n + 1\n        n = m * 10\n        m += n\n");
  Give("n", 4);
  Run();
  EXPECT_EQ(After("n"), "50");
  EXPECT_EQ(After("m"), "55");
}

TEST_F(EventExecution, IncrementAddsOne) {
  Load("local:\n    int n\n    float f\nE:\n    eff:\n        n++\n        f++\n");
  Give("n", -1);
  Give("f", arena_.Number(arena_.Real(), *expr::Rational::Parse("0.5")));
  Run();
  EXPECT_EQ(After("n"), "0");
  EXPECT_EQ(After("f"), "1.5");
}

TEST_F(EventExecution, PointsAreAddedByCoordinate) {
  Load("local:\n    pos p\nE:\n    eff:\n        p = pos(1, 2, 3)\n        p += pos(10, 20, 30)\n");
  Run();
  EXPECT_EQ(After("p"), "(11, 22, 33)");
}

TEST_F(EventExecution, OnlyTheBranchOfTheConditionRuns) {
  Load(
      "local:\n    int n\n    int m\nE:\n    eff:\n        if n < 0:\n            m = 1\n        elif n == 0:\n"
      "            m = 2\n        else:\n            m = 3\n");
  for (const auto& [n, m] : {std::pair(-1, "1"), {0, "2"}, {1, "3"}}) {
    Give("n", n);
    Run();
    EXPECT_EQ(After("m"), m);
  }
}

TEST_F(EventExecution, AnIntBecomesAFloatWhereOneIsNeeded) {
  Load("local:\n    int n\n    float f\nE:\n    eff:\n        f = n\n        f = f / 2\n");
  Give("n", 3);
  Run();
  EXPECT_EQ(After("f"), "1.5");
}

TEST_F(EventExecution, StopEndsTheEventAndTheRobot) {
  Load("local:\n    int n\nE:\n    eff:\n        if n > 0:\n            stop\n        n = 9\n");
  Give("n", 1);
  Run();
  EXPECT_EQ(After("n"), "1");
  EXPECT_EQ(Text(effect_.stops), "true");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "9");
  EXPECT_EQ(Text(effect_.stops), "false");
}

TEST_F(EventExecution, ReturnEndsTheEventOnly) {
  Load("local:\n    int n\nE:\n    eff:\n        if n > 0:\n            return\n        n = 9\n");
  Give("n", 1);
  Run();
  EXPECT_EQ(After("n"), "1");
  EXPECT_EQ(Text(effect_.stops), "false");
}

TEST_F(EventExecution, RangesAreHalfOpen) {
  Load(
      "local:\n    int n\n    int last\nE:\n    eff:\n        for i = 2, 5:\n            n += i\n            last = i\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "9");
  EXPECT_EQ(After("last"), "4");
}

TEST_F(EventExecution, AnEmptyRangeDoesNothing) {
  Load("local:\n    int n\nE:\n    eff:\n        for i = 5, 2:\n            n = 100\n");
  Give("n", 7);
  Run();
  EXPECT_EQ(After("n"), "7");
}

TEST_F(EventExecution, BreakLeavesTheInnermostLoop) {
  Load(
      "local:\n    int n\nE:\n    eff:\n        for i = 0, 3:\n            for j = 0, 3:\n"
      "                if j == 1:\n                    break\n                n += 1\n            n += 10\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "33");
}

TEST_F(EventExecution, ContinueLeavesOneIteration) {
  Load(
      "local:\n    int n\nE:\n    eff:\n        for i = 0, 4:\n            if i == 1:\n                continue\n"
      "            n += i\n        n += 100\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "105");
}

TEST_F(EventExecution, ReturnInALoopLeavesAllOfThem) {
  Load(
      "local:\n    int n\nE:\n    eff:\n        for i = 0, 4:\n            for j = 0, 4:\n"
      "                if i == 1:\n                    return\n                n += 1\n        n += 100\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "4");
}

TEST_F(EventExecution, ALoopOverAListTakesItsItemsInOrder) {
  Load("local:\n    int n\nE:\n    eff:\n        for x in [1, 2, 3]:\n            n = n * 10 + x\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "123");
}

TEST_F(EventExecution, ALoopOverPairsNamesBothParts) {
  Load("local:\n    int n\nE:\n    eff:\n        for a, b in [(1, 2), (3, 4)]:\n            n += a * b\n");
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "14");
}

TEST_F(EventExecution, ALoopOverCellsLooksAtEveryRobot) {
  Load(
      "allread:\n    int x[N_sys]\nlocal:\n    int n\nE:\n    eff:\n        for c in x:\n            n += c\n");
  for (int64_t r = 0; r < kRobots; ++r) Give("x", 10 + r, r);
  Give("n", 0);
  Run();
  EXPECT_EQ(After("n"), "33");
}

TEST_F(EventExecution, ALoopWithoutABoundIsReported) {
  Load("local:\n    int n\n    List<int> l\nE:\n    eff:\n        for x in l:\n            n += x\n");
  Run();
  ASSERT_EQ(diagnostics_.all().size(), 1U);
  EXPECT_EQ(diagnostics_.all()[0].kind, diag::Kind::kKoordUnboundedLoop);
}

TEST_F(EventExecution, AnInvariantBoundsALoopAndTheBoundIsChecked) {
  Load(
      "local:\n    int n\n    List<int> l\nE:\n    eff:\n        for x in l:\n            n += 1\n"
      "invariant: len(l) < 3\n");
  Give("n", 0);
  Run();
  EXPECT_TRUE(diagnostics_.all().empty());
  for (const auto& [length, times, bad] : {std::tuple(0, "0", 0U), {2, "2", 0U}, {3, "2", 1U}}) {
    length_ = length;
    EXPECT_EQ(After("n"), times);
    EXPECT_EQ(Undefined(CheckKind::kUnrolling), bad);
  }
}

TEST_F(EventExecution, ARangeBeyondTheUnrollingIsReported) {
  Load("local:\n    int n\nE:\n    eff:\n        for i = 0, 5:\n            n += 1\n");
  Run({.unrolling = 5});
  EXPECT_TRUE(diagnostics_.all().empty());
  Run({.unrolling = 4});
  ASSERT_EQ(diagnostics_.all().size(), 1U);
  EXPECT_EQ(diagnostics_.all()[0].kind, diag::Kind::kKoordUnboundedLoop);
}

TEST_F(EventExecution, ARobotWritesItsOwnCellAndReadsTheOthers) {
  Load("allread:\n    int x[N_sys]\nE:\n    eff:\n        x[pid] = x[pid] * 100 + x[(pid + 1) % N_sys]\n");
  Give("x", 1, 1);
  Give("x", 2, 2);
  Run();
  EXPECT_EQ(After("x"), "102");
}

TEST_F(EventExecution, ACellOfNoRobotIsUndefined) {
  Load("allread:\n    int x[N_sys]\nlocal:\n    int k\nE:\n    eff:\n        x[pid] = x[k]\n");
  for (const auto& [k, bad] : {std::pair(-1, 1U), {0, 0U}, {2, 0U}, {3, 1U}}) {
    Give("k", k);
    Run();
    EXPECT_EQ(Undefined(CheckKind::kIndex), bad) << k;
  }
}

TEST_F(EventExecution, AConditionGuardsTheOperationBehindIt) {
  Load(
      "local:\n    int a[3]\n    int k\n    bool b\nE:\n    eff:\n        b = k >= 0 and k < 3 and a[k] == 1\n"
      "        b = k < 0 or k >= 3 or a[k] == 1\n        if k >= 0 and k < 3:\n            a[k] = 2\n");
  Give("k", 3);
  Run();
  EXPECT_EQ(Undefined(CheckKind::kIndex), 0U);
}

TEST_F(EventExecution, AnOperationBehindTheWrongConditionIsUndefined) {
  Load("local:\n    int a[3]\n    int k\n    bool b\nE:\n    eff:\n        b = k < 0 or a[k] == 1\n");
  Give("k", 3);
  Run();
  EXPECT_EQ(Undefined(CheckKind::kIndex), 1U);
}

TEST_F(EventExecution, EveryDepthOfAnArrayHasItsIndex) {
  Load("local:\n    int a[2][3]\n    int i\n    int j\nE:\n    eff:\n        a[i][j] = 5\n");
  for (const auto& [i, j, bad] : {std::tuple(1, 2, 0U), {2, 1, 1U}, {1, 3, 1U}, {-1, -1, 2U}}) {
    Give("i", i);
    Give("j", j);
    Run();
    EXPECT_GE(Undefined(CheckKind::kIndex), bad) << i << " " << j;
    EXPECT_EQ(Undefined(CheckKind::kIndex) == 0, bad == 0) << i << " " << j;
  }
}

TEST_F(EventExecution, AnItemIsWrittenInPlace) {
  Load("local:\n    int a[3]\nE:\n    eff:\n        a[0] = 4\n        a[1] = a[0] + 1\n        a[0] = 6\n");
  Run();
  EXPECT_EQ(After("a", 0), "6");
  EXPECT_EQ(After("a", 1), "5");
}

TEST_F(EventExecution, AMemberIsWrittenInPlace) {
  Load(
      "def adt Task:\n    int id\n    pos at\nlocal:\n    Task t\nE:\n    eff:\n        t.id = 3\n"
      "        t.at = pos(1, 2, 3)\n        t.at.y = 7\n");
  Run();
  EXPECT_EQ(After("t"), "(3, (1, 7, 3))");
}

TEST_F(EventExecution, TheLockIsTakenWhereAtomicIsReached) {
  Load(
      "allwrite:\n    int s\nlocal:\n    int n\nE:\n    eff:\n        if n > 0:\n            atomic:\n                s = 1\n");
  for (const auto& [n, locks, writes] : {std::tuple(1, "true", 1U), {0, "false", 0U}}) {
    Give("n", n);
    Run();
    EXPECT_EQ(Text(effect_.locks), locks);
    EXPECT_EQ(Writes(), writes);
  }
}

TEST_F(EventExecution, BehindReturnThereIsNoLockAndNoWrite) {
  Load(
      "allwrite:\n    int s\nlocal:\n    int n\nE:\n    eff:\n        if n > 0:\n            return\n        atomic:\n            s = 1\n");
  Give("n", 1);
  Give("s", 8);
  Run();
  EXPECT_EQ(Text(effect_.locks), "false");
  EXPECT_EQ(Writes(), 0U);
  EXPECT_EQ(After("s"), "8");
}

TEST_F(EventExecution, AWriteOfASharedCellNamesItsIndices) {
  Load("allwrite:\n    int g[2][3]\nE:\n    eff:\n        atomic:\n            g[1][2] = 4\n");
  Run();
  ASSERT_EQ(effect_.writes.size(), 1U);
  ASSERT_EQ(effect_.writes[0].indices.size(), 2U);
  EXPECT_EQ(Text(effect_.writes[0].indices[0]), "1");
  EXPECT_EQ(Text(effect_.writes[0].indices[1]), "2");
}

TEST_F(EventExecution, ReadsOfOthersAreRecorded) {
  Load("allread:\n    int x[N_sys]\nlocal:\n    int n\nE:\n    pre: x[2] > 0\n    eff:\n        n = x[0]\n");
  Give("x", 5, 0);
  Give("x", 6, 2);
  Run();
  ASSERT_EQ(effect_.reads.size(), 2U);
  EXPECT_EQ(Text(effect_.reads[0].index) + ": " + Text(effect_.reads[0].value), "2: 6");
  EXPECT_EQ(Text(effect_.reads[1].index) + ": " + Text(effect_.reads[1].value), "0: 5");
}

TEST_F(EventExecution, AChoiceIsWithinItsRange) {
  Load("local:\n    int n\nE:\n    eff:\n        n = any int in 2..4\n");
  Run();
  for (const auto& [choice, allowed] : {std::pair(1, "false"), {2, "true"}, {4, "true"}, {5, "false"}}) {
    choice_ = choice;
    EXPECT_EQ(Text(effect_.chosen), allowed) << choice;
    EXPECT_EQ(After("n"), std::to_string(choice));
  }
}

TEST_F(EventExecution, AChoiceThatIsNotReachedIsFree) {
  Load("local:\n    int n\nE:\n    eff:\n        if n > 0:\n            n = any int in 2..4\n");
  Give("n", 0);
  choice_ = 17;
  Run();
  EXPECT_EQ(Text(effect_.chosen), "true");
  EXPECT_EQ(After("n"), "0");
}

TEST_F(EventExecution, AChoiceAmongNothingIsUndefined) {
  Load("local:\n    int n\n    int m\nE:\n    eff:\n        n = any int in 2..m\n");
  Give("m", 2);
  Run();
  EXPECT_EQ(Undefined(CheckKind::kChoice), 0U);
  Give("m", 1);
  Run();
  EXPECT_EQ(Undefined(CheckKind::kChoice), 1U);
}

TEST_F(EventExecution, InitBlocksRunInOrderAndReturnEndsItsOwn) {
  Load(
      "local:\n    int n\ninit:\n    n = 1\n    if n == 1:\n        return\n    n = 50\ninit:\n    n = n * 10 + 2\n"
      "E:\n    eff:\n        n = 0\n");
  Executor executor(*vocabulary_, diagnostics_);
  effect_ = executor.RunInit(start_, Int(kSelf));
  EXPECT_EQ(After("n"), "12");
  EXPECT_EQ(Text(effect_.enabled), "true");
}

}  // namespace
}  // namespace rondo::koord
