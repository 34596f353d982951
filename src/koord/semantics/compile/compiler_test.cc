#include "koord/semantics/compile/compiler.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/semantics/machine/machine.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::semantics {
namespace {

// A program of one event, compiled for a team of three.
class Compiled {
 public:
  explicit Compiled(const std::string& text) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    EXPECT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message << "\n" << text;
    if (diagnostics_.has_errors()) return;
    layout_ = std::make_unique<Layout>(model_, 3, Lengths{{"2", 2}, {"3", 3}, {kRobotsLength, 3}});
    compiler_ = std::make_unique<Compiler>(model_, *layout_, heap_, code_);
    entry_ = compiler_->Statements(model_.events[0]->body);
    unsupported_ = compiler_->TakeUnsupported();
    for (const InvariantDef* def : model_.invariants) {
      formulas_.push_back(compiler_->Formula(def->body));
      robots_.push_back(compiler_->used_robot());
      if (auto bad = compiler_->TakeUnsupported()) unsupported_ = bad;
    }
    machine_ = std::make_unique<Machine>(code_, *layout_, heap_);
    machine_->marks().resize(compiler_->branches().size());
    memory_.resize(layout_->words());
    machine_->SetMemory(memory_.data());
  }
  Fault Run(size_t robot = 0) {
    machine_->Run(entry_, robot, false);
    return machine_->fault();
  }
  bool Holds(size_t formula = 0, size_t robot = 0) { return machine_->RunFormula(formulas_[formula], robot); }
  Word& At(const std::string& name, size_t robot = 0) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].name == name) return memory_[layout_->Address(v, robot)];
    }
    ADD_FAILURE() << "no variable " << name;
    return memory_[0];
  }
  int64_t Int(const std::string& name) { return ToInt(At(name)); }

  Heap heap_;
  Code code_;
  std::unique_ptr<Compiler> compiler_;
  std::unique_ptr<Machine> machine_;
  std::optional<Unsupported> unsupported_;
  std::vector<bool> robots_;

 private:
  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  std::unique_ptr<Layout> layout_;
  std::vector<Word> memory_;
  uint32_t entry_ = 0;
  std::vector<uint32_t> formulas_;
};

const char* const kVariables =
    "def fun first(List<int> xs) -> int:\n"
    "    for x in xs:\n"
    "        return x\n"
    "def adt Rec:\n"
    "    int a\n"
    "    pos p\n"
    "allread:\n"
    "    int x[N_sys]\n"
    "local:\n"
    "    int n\n"
    "    int m\n"
    "    bool b\n"
    "    float f\n"
    "    string s\n"
    "    Rec r\n"
    "    List<int> l\n"
    "    int g[2][3]\n";

// The program with these lines as the body of its event.
std::string Go(const std::vector<std::string>& lines) {
  std::string text = std::string(kVariables) + "Go:\n    eff:\n";
  for (const std::string& line : lines) text += "        " + line + "\n";
  return text;
}
std::string Formula(const std::string& formula) { return Go({"n = 1"}) + "invariant i: " + formula + "\n"; }

// What `n` is behind the lines.
int64_t After(const std::vector<std::string>& lines) {
  Compiled program(Go(lines));
  EXPECT_EQ(program.Run(), Fault::kNone);
  return program.Int("n");
}

TEST(Compiler, OperatorsBindAsTheLanguageSays) {
  EXPECT_EQ(After({"n = 2 + 3 * 4 - 1"}), 13);
  EXPECT_EQ(After({"n = -7 / 2 + 10"}), 6);
  EXPECT_EQ(After({"n = (2 + 3) * -7 % 4"}), 1);
}

TEST(Compiler, AnIntBecomesAFloatWhereOneIsNeeded) {
  Compiled program(Go({"f = 1", "f += 1", "f = f / 4"}));
  EXPECT_EQ(program.Run(), Fault::kNone);
  EXPECT_EQ(ToFloat(program.At("f")), 0.5);
}

TEST(Compiler, AJunctionLooksNoFurtherThanItMust) {
  EXPECT_EQ(After({"b = n == 0 or 1 / n > 0", "if b:", "    n = 4"}), 4);
  EXPECT_EQ(After({"b = n != 0 and 1 / n > 0", "if not b:", "    n = 5"}), 5);
  EXPECT_EQ(After({"b = n != 0 implies 1 / n > 0", "if b:", "    n = 6"}), 6);
}

TEST(Compiler, OneBranchIsTaken) {
  const std::vector<std::string> lines{
      "if m == 1:", "    n = 10", "elif m == 2:", "    n = 20", "else:", "    n = 30"};
  for (const int64_t m : {1, 2, 3}) {
    Compiled program(Go(lines));
    program.At("m") = FromInt(m);
    program.Run();
    EXPECT_EQ(program.Int("n"), 10 * m);
  }
}

TEST(Compiler, BranchesAreMarkedWhenTheyAreTaken) {
  Compiled program(Go({"if m == 1:", "    n = 1", "else:", "    n = 2"}));
  program.Run();
  EXPECT_EQ(program.machine_->marks(), (std::vector<bool>{false, true}));
  program.At("m") = 1;
  program.Run();
  EXPECT_EQ(program.machine_->marks(), (std::vector<bool>{true, true}));
}

TEST(Compiler, ARangeIsHalfOpen) {
  EXPECT_EQ(After({"for i = 2, 5:", "    n = 10 * n + i"}), 234);
  EXPECT_EQ(After({"for i = 5, 5:", "    n = 1"}), 0);
}

TEST(Compiler, ContinueAndBreakLeaveTheInnerLoop) {
  EXPECT_EQ(After({"for i = 0, 6:", "    if i == 1:", "        continue", "    if i == 4:", "        break",
                   "    n = 10 * n + i"}),
            23);
  EXPECT_EQ(
      After({"for i = 0, 2:", "    for j = 0, 9:", "        if j == 2:", "            break", "        n++"}),
      4);
}

TEST(Compiler, ALoopOverAListHasItsItemsInOrder) {
  EXPECT_EQ(After({"l = [3, 1, 2]", "for v in l:", "    l.append(7)", "    n = 10 * n + v"}), 312);
}

TEST(Compiler, AppendAndRemoveChangeTheVariable) {
  EXPECT_EQ(After({"l = [4]", "l.append(5)", "l.append(4)", "l.remove(4)", "n = 10 * l[0] + l[1]"}), 54);
  Compiled program(Go({"l.remove(1)"}));
  EXPECT_EQ(program.Run(), Fault::kRemove);
}

TEST(Compiler, AListThatIsAssignedIsACopy) {
  EXPECT_EQ(After({"l = [1, 2]", "for v in [l]:", "    l[0] = 9", "    n = v[0]"}), 1);
}

TEST(Compiler, AMemberIsAPartOfTheWhole) {
  EXPECT_EQ(After({"r.a = 5", "r.p = pos(1, 2, 3)", "r.p.y = 8", "if r.p == pos(1, 8, 3):", "    n = r.a"}),
            5);
}

TEST(Compiler, CellsOfNestedArraysLieApart) {
  EXPECT_EQ(
      After({"for i = 0, 2:", "    for j = 0, 3:", "        g[i][j] = 10 * i + j", "n = g[1][0] + g[0][2]"}),
      12);
  EXPECT_EQ(After({"g[1][2] = 7", "g[0] = g[1]", "n = g[0][2]"}), 7);
}

TEST(Compiler, EveryLevelOfANestedIndexIsChecked) {
  Compiled inner(Go({"n = g[0][m + 3]"}));
  EXPECT_EQ(inner.Run(), Fault::kIndex);
  Compiled outer(Go({"g[m + 2][0] = 1"}));
  EXPECT_EQ(outer.Run(), Fault::kIndex);
}

TEST(Compiler, ARobotHasItsOwnCell) {
  Compiled program(Go({"x[pid] = pid + N_sys", "n = x[1]"}));
  program.At("x", 1) = 42;
  EXPECT_EQ(program.Run(2), Fault::kNone);
  EXPECT_EQ(program.At("x", 2), 5U);
  EXPECT_EQ(program.At("n", 2), 42U);
}

TEST(Compiler, AFunctionReturnsFromInsideALoop) {
  EXPECT_EQ(After({"n = first([8, 9])"}), 8);
  Compiled program(Go({"n = first(l)"}));
  EXPECT_EQ(program.Run(), Fault::kReturn);
}

TEST(Compiler, StopEndsTheEvent) {
  Compiled program(Go({"n = 1", "stop", "n = 2"}));
  program.Run();
  EXPECT_TRUE(program.machine_->stopped());
  EXPECT_EQ(program.Int("n"), 1);
}

TEST(Compiler, ReturnEndsTheEventWithoutStopping) {
  Compiled program(Go({"n = 1", "return", "n = 2"}));
  program.Run();
  EXPECT_FALSE(program.machine_->stopped());
  EXPECT_EQ(program.Int("n"), 1);
}

TEST(Compiler, TheLockIsTakenWhereItIsReached) {
  Compiled program(Go({"if m == 1:", "    atomic:", "        n = 1"}));
  program.Run();
  EXPECT_FALSE(program.machine_->locked());
  program.At("m") = 1;
  program.Run();
  EXPECT_TRUE(program.machine_->locked());
}

TEST(Compiler, TextsAreUnquoted) {
  Compiled program(Go({"s = \"a\\n\\\"b\" + \"c\""}));
  program.Run();
  EXPECT_EQ(program.heap_.Text(program.At("s")), "a\n\"bc");
}

TEST(Compiler, BuiltinsAreThoseOfTheLanguage) {
  EXPECT_EQ(After({"n = min(3, 1, 2) + 10 * max(3, 4) + 100 * abs(-5) + 1000 * len([7, 7])"}), 2541);
  EXPECT_EQ(After({"if dist(pos(0, 0, 0), mid(pos(0, 0, 0), pos(0, 6, 8))) == 5:", "    n = 1"}), 1);
  EXPECT_EQ(After({"if dist(2, -1.5) == 3.5 and mid(1, 4) == 2.5:", "    n = 1"}), 1);
  EXPECT_EQ(After({"if pos(1, 2) in rect(pos(1, 0), pos(1, 2)) and not (3 in [1, 2]):", "    n = 1"}), 1);
}

TEST(Compiler, ALiteralThatIsNoDoubleIsRemembered) {
  EXPECT_FALSE(Compiled(Go({"f = 0.5"})).code_.rounded_literals);
  EXPECT_TRUE(Compiled(Go({"f = 0.1"})).code_.rounded_literals);
}

TEST(Compiler, QuantifiersRangeOverRobots) {
  Compiled program(Formula("forall i in ID: x[i] > 0") + "invariant j: exists i in ID: x[i] == 2\n");
  for (size_t r = 0; r < 3; ++r) program.At("x", r) = 1;
  EXPECT_TRUE(program.Holds(0));
  EXPECT_FALSE(program.Holds(1));
  program.At("x", 2) = 2;
  EXPECT_TRUE(program.Holds(1));
  program.At("x", 2) = 0;
  EXPECT_FALSE(program.Holds(0));
}

TEST(Compiler, QuantifiersRangeOverIntsThatAreBounded) {
  EXPECT_TRUE(Compiled(Formula("exists k in int: 3 < k and k <= 4")).Holds());
  EXPECT_FALSE(Compiled(Formula("exists k in int: 3 < k and k < 4")).Holds());
  EXPECT_FALSE(Compiled(Formula("forall k in int: 0 <= k and k < 5 implies k != 4")).Holds());
  EXPECT_TRUE(Compiled(Formula("forall j, k in int: 0 <= j and j < k and k < 4 implies k > 0")).Holds());
}

TEST(Compiler, AQuantifierOverNothingIsForallTrueAndExistsFalse) {
  EXPECT_TRUE(Compiled(Formula("forall k in int: 3 < k and k < 2 implies false")).Holds());
  EXPECT_FALSE(Compiled(Formula("exists v in l: true")).Holds());
}

TEST(Compiler, UnboundedQuantifiersAreNotExecutable) {
  EXPECT_TRUE(Compiled(Formula("forall k in int: k * k >= 0")).unsupported_.has_value());
  EXPECT_TRUE(Compiled(Formula("forall k in float: k > 0 implies k >= 0")).unsupported_.has_value());
  EXPECT_FALSE(Compiled(Formula("forall k in bool: k or not k")).unsupported_.has_value());
}

TEST(Compiler, AFormulaKnowsWhetherItIsAboutARobot) {
  EXPECT_TRUE(Compiled(Formula("n >= 0")).robots_[0]);
  EXPECT_FALSE(Compiled(Formula("forall i in ID: n[i] >= 0")).robots_[0]);
}

TEST(Compiler, FormulasAreTotal) {
  Compiled program(Formula("1 / n == 0"));
  EXPECT_TRUE(program.Holds());
  EXPECT_TRUE(program.machine_->used_default());
}

}  // namespace
}  // namespace rondo::koord::semantics
