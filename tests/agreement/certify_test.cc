// The checker of certificates accepts no refutation of what has a solution, whatever is written in it.
#include <gtest/gtest.h>

#include "formulas.h"
#include "solve/icp/icp_solver.h"
#include "verdict/truth.h"

namespace rondo::solve {
namespace {

using testing_support::Formulas;
using testing_support::Rejected;
using testing_support::Say;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string Join(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& l : lines) text += l + "\n";
  return text;
}

// One small change to the lines from `first` on.
void Change(std::vector<std::string>& lines, size_t first, std::mt19937_64& rng) {
  if (first >= lines.size()) return;
  const auto pick = [&] { return first + rng() % (lines.size() - first); };
  const size_t at = pick();
  std::string& line = lines[at];
  switch (rng() % 6) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
      return;
    case 1:
      std::swap(lines[at], lines[pick()]);
      return;
    case 2:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[pick()]);
      return;
    case 3: {  // another digit
      const size_t digit = line.find_first_of("0123456789", rng() % std::max<size_t>(1, line.size()));
      if (digit != std::string::npos) line[digit] = static_cast<char>('0' + rng() % 10);
      return;
    }
    case 4: {
      const size_t relation = line.find("<=");
      if (relation != std::string::npos) line.replace(relation, 2, rng() % 2 == 0 ? "<" : ">=");
      return;
    }
    default: {
      static constexpr const char* kEnds[] = {"(contradiction)", "(end)", "(search (x) \".\")",
                                              "(search (x y z) \"0 0 . .\")"};
      lines[at] = kEnds[rng() % 4];
    }
  }
}

// A refutation under a script from which an assertion was taken away, so that it has solutions.
TEST(Certify, RefutesNothingThatHasASolution) {
  const Budget budget{std::chrono::milliseconds(1000), false, true};
  icp::Options few;
  few.max_boxes = 20'000;
  std::mt19937_64 rng(1);
  int tried = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const Formulas f(seed, seed % 2 == 0);
    const Answer answer = icp::IcpSolver(few).Check(f.query(), budget, {});
    const auto* unsat = std::get_if<Unsat>(&answer);
    if (unsat == nullptr) continue;
    ASSERT_EQ(Rejected(unsat->certificate), "") << unsat->certificate;
    const std::string proof =
        unsat->certificate.substr(ToSmtLib(f.query(), expr::SmtFunctions::kNamed).size());
    for (size_t without = 0; without < f.query().assertions.size(); ++without) {
      Query weaker = f.query();
      weaker.assertions.erase(weaker.assertions.begin() + static_cast<std::ptrdiff_t>(without));
      if (Say(icp::IcpSolver(few).Check(weaker, budget, {})) != "sat") continue;
      const std::vector<std::string> script = Lines(ToSmtLib(weaker, expr::SmtFunctions::kNamed));
      for (int change = 0; change < 12; ++change) {
        std::vector<std::string> lines = script;
        for (const std::string& l : Lines(proof)) lines.push_back(l);
        for (int i = 0; i < change / 2; ++i) Change(lines, script.size(), rng);
        ++tried;
        ASSERT_NE(Rejected(Join(lines)), "") << "seed " << seed << " without assertion " << without << "\n"
                                             << Join(lines);
      }
    }
  }
  EXPECT_GT(tried, 500);
}

const std::string kHead =
    "(declare-fun x () Real)(declare-fun y () Real)(declare-fun n () Int)(declare-fun b () Bool)";

TEST(Certify, SaysWhatDoesNotFollow) {
  const auto said = [](const std::string& text) { return Rejected(kHead + text); };
  EXPECT_EQ(said("(assert (< x 0.0))(assert (> x 0.0))(contradiction)"), "");
  EXPECT_EQ(said("(assert (<= x 0.0))(assert (>= x 0.0))(contradiction)"), "no contradiction is known here");
  EXPECT_EQ(said("(assert (<= x 0.0))"), "the proof ends here, with a case that is not closed");
  EXPECT_EQ(said("(assert (<= x 0.0))(fact (<= x (- 1.0)))"), "this does not follow from what is known");
  EXPECT_EQ(said("(assert (<= x 0.0))(substitute x y)"), "it is not known that the variable has this value");
  EXPECT_EQ(said("(assert (<= x 0.0))(cases (or (<= x 1.0) (>= x 2.0)))(end)"), "an alternative is missing");
  EXPECT_EQ(said("(assert (<= x 0.0))(cases (or (<= x 1.0) (>= y 2.0)))(case (>= y 2.0))(contradiction)"),
            "no contradiction is known here");
  EXPECT_EQ(said("(assert (<= x 0.0))(push 1)(contradiction)"), "a certificate has no such command");
  EXPECT_EQ(said("(assert (<= x 0.0))(squares (<= (* x x) 0.0))"), "this does not follow from what is known");
  EXPECT_EQ(said("(assert (<= x 0.0))(fact (<= x 0.0))(search (x) \".\")"),
            "box 1 of the search is not empty");
  EXPECT_EQ(said("(assert (<= x 0.0))(fact (<= x 0.0))(search (x) \"0 1 .\")"),
            "box 2 of the search is not empty");
  EXPECT_EQ(said("(assert (<= x 0.0))(fact (<= x 0.0))(search (y) \".\")"),
            "a variable of the search occurs in no fact");
}

// Facts about which the last bit, definedness or the domain decides.
TEST(Certify, IsNotFooled) {
  const auto bad = [](const std::string& text) { return !Rejected(kHead + text).empty(); };
  // That a root cancels does not make it defined.
  EXPECT_TRUE(bad("(assert (< y 0.0))(fact (<= (+ x (sqrt y) (- (sqrt y))) x))(search (y) \".\")"));
  EXPECT_TRUE(
      bad("(assert (< y 0.0))(assert (<= x 0.0))"
          "(fact (<= (+ x (* 0.0 (sqrt y))) 0.0))(search (x y) \".\")"));
  EXPECT_TRUE(
      bad("(assert (<= y (- 1.0)))(fact (<= y (- 1.0)))"
          "(fact (or (<= (sqrt y) 1.0) (<= (- (sqrt y)) (- 1.0)) (<= y 0.0)))(search (y) \".\")"));
  // A disjunct that is undefined refutes nothing.
  EXPECT_TRUE(
      bad("(assert (<= y (- 1.0)))(assert (or (<= (sqrt y) 1.0) (<= y 0.0)))(fact (<= y (- 1.0)))"
          "(fact (or (<= (sqrt y) 1.0) (<= y 0.0)))(search (y) \".\")"));
  // Quotients by 0 have values.
  EXPECT_TRUE(
      bad("(assert (= x 0.0))(assert (= y (/ 1.0 x)))(substitute x 0.0)(fact (= y (/ 1.0 0.0)))"
          "(search (y) \".\")"));
  EXPECT_TRUE(
      bad("(assert (<= (- 1.0) x 1.0))(assert (>= (/ 1.0 x) 1e9))(fact (<= (- 1.0) x))(fact (<= x 1.0))"
          "(fact (>= (/ 1.0 x) 1e9))(search (x) \"0 0 . .\")"));
  // Integers are rounded inward, reals are not.
  EXPECT_FALSE(bad("(assert (< 0 n 1))(contradiction)"));
  EXPECT_TRUE(bad("(assert (< 0.0 x 1.0))(contradiction)"));
  EXPECT_TRUE(bad("(assert (<= 0 n 1))(fact (<= 0 n 1))(search (n) \"0 0.5 . .\")"));
  // verdict::Truth values are 0 or 1.
  EXPECT_FALSE(bad("(assert b)(assert (not b))(contradiction)"));
  EXPECT_TRUE(bad("(assert b)(fact b)(search (b) \".\")"));
  // A bound that a double would round away.
  EXPECT_TRUE(bad("(assert (< x 0.1000000000000000000000001))(assert (> x 0.1))(contradiction)"));
  EXPECT_TRUE(
      bad("(assert (< x 0.1000000000000000000000001))(assert (> x 0.1))"
          "(fact (< x 0.1000000000000000000000001))(fact (> x 0.1))(search (x) \"0 0.1 . .\")"));
  // Ends of the domain belong to it.
  EXPECT_TRUE(bad("(assert (<= (asin x) (- 1.5)))(fact (<= (asin x) (- 1.5)))(search (x) \"0 0 . .\")"));
  EXPECT_TRUE(bad("(assert (<= (sqrt x) 0.0))(contradiction)"));
  EXPECT_TRUE(
      bad("(assert (= (sin x) 1.0))(assert (<= 1.5 x 1.6))(fact (= (sin x) 1.0))(fact (<= 1.5 x))"
          "(fact (<= x 1.6))(search (x) \"0 1.5707963267948966 . .\")"));
  // The root in a branch that is not taken says nothing of the root beside it.
  EXPECT_TRUE(
      bad("(declare-fun z () Real)(assert (= x (- 1.0)))(assert (= z 1.0))"
          "(assert (<= (ite (<= z 0.0) (sqrt x) 1.0) 5.0))(fact (= x (- 1.0)))"
          "(fact (<= (+ (ite (<= z 0.0) (sqrt x) 1.0)"
          " (- (* (+ y 1.0) (sqrt x)) (* y (sqrt x)) (sqrt x))) 5.0))(search (x) \".\")"));
  EXPECT_TRUE(
      bad("(declare-fun z () Real)(assert (= x (- 1.0)))(assert (= z 1.0))"
          "(assert (<= (ite (or (<= 0.0 z) (<= (sqrt x) 7.0)) 3.0 1.0) 5.0))(fact (= x (- 1.0)))"
          "(fact (<= (+ (ite (or (<= 0.0 z) (<= (sqrt x) 7.0)) 3.0 1.0)"
          " (- (* (+ y 1.0) (sqrt x)) (* y (sqrt x)) (sqrt x))) 5.0))(search (x) \".\")"));
  // Names keep their meaning, and nothing is asserted behind a refutation.
  EXPECT_TRUE(bad("(let x 5.0)(assert (< x 0.0))(contradiction)"));
  EXPECT_TRUE(bad("(define-fun |1.0| () Real 0.0)(assert (< 0.6 1.0))(contradiction)"));
  EXPECT_TRUE(bad("(define-fun true () Bool false)(assert true)(contradiction)"));
  EXPECT_TRUE(bad("(define-fun <= ((a Real)(c Real)) Bool false)(assert (<= 1.0 2.0))(contradiction)"));
  // A square may vanish, and a difference of squares does not vanish summand by summand.
  EXPECT_TRUE(bad("(assert (<= (* x x) 0.0))(squares (<= (* x x) 0.0))(contradiction)"));
  EXPECT_TRUE(bad("(assert (<= (- (* x x) (* y y)) 0.0))(squares (<= (- (* x x) (* y y)) 0.0))"));
  EXPECT_TRUE(
      bad("(assert (<= (+ (* (- 2.0) x x) (* y y)) 0.0))(squares (<= (+ (* (- 2.0) x x) (* y y)) 0.0))"));
  // A sum that is not zero is no identity.
  EXPECT_TRUE(bad("(assert (<= x 1.0))(fact (<= x 1.0))(identity 1.0 x 1.0)(search (x) \".\")"));
  // A window of less than a turn, or beside bounds of the variable itself, leaves angles out.
  EXPECT_TRUE(bad("(assert (>= (sin x) 0.0))(period x 0.0 6.0)(contradiction)"));
  EXPECT_TRUE(bad(
      "(assert (>= (sin x) 0.5))(assert (>= x 100.0))(period x 0.0 7.0)(fact (>= x 100.0))(contradiction)"));
  EXPECT_TRUE(
      bad("(assert (>= (sin x) 0.5))(assert (>= x 100.0))(assert (<= x 101.0))(period x 0.0 "
          "7.0)(contradiction)"));
  EXPECT_TRUE(
      bad("(assert (<= (sin x) (- 0.999)))(period x (- 1.5) 4.6)(fact (<= (sin x) (- 0.999)))"
          "(fact (<= (- 1.5) x))(fact (<= x 4.6))(search (x) \"0 1.5 . .\")"));
  EXPECT_TRUE(bad("(assert (>= x 0.0))(fact (>= x 0.0))(identity 1.0 x 1.0)(search (x) \".\")"));
  EXPECT_TRUE(
      bad("(assert (= x 1.0))(assert (= y 1.0))(assert (<= (+ (* (- 2.0) (* x x)) (* y y)) 0.0))"
          "(squares (<= (+ (* (- 2.0) (* x x)) (* y y)) 0.0))(contradiction)"));
  EXPECT_TRUE(
      bad("(assert (or (<= x 0.0) (>= x 1.0)))(assert (<= x 0.5))(fact (or (<= x 0.0) (>= x 1.0)))"
          "(fact (<= x 0.5))(search (x) \".\")"));
  EXPECT_TRUE(
      bad("(assert (or (<= x 0.0) (>= x 1.0)))(assert (>= x 0.5))(fact (or (<= x 0.0) (>= x 1.0)))"
          "(fact (>= x 0.5))(search (x) \".\")"));
  // A root is never negative, so a negative lower bound says nothing of its argument.
  EXPECT_TRUE(bad("(assert (>= (sqrt x) (- 3.0)))(assert (<= x 1.0))(contradiction)"));
  // Of two alternatives that may both hold, neither is demanded; a choice has both values.
  EXPECT_TRUE(
      bad("(assert (or (<= x 0.0) (>= x 1.0)))(assert (<= x 5.0))(fact (<= x 5.0))"
          "(fact (or (>= x 1.0) (<= x 0.0)))(fact (or (<= x 0.0) (>= x 1.0)))(search (x) \".\")"));
  EXPECT_TRUE(
      bad("(assert (= y (ite (<= x 0.0) 1.0 2.0)))(assert (>= y 1.5))(fact (= y (ite (<= x 0.0) 1.0 2.0)))"
          "(fact (>= y 1.5))(search (x y) \".\")"));
  EXPECT_TRUE(
      bad("(assert (= y (ite (<= x 0.0) 1.0 2.0)))(assert (<= y 1.5))(fact (= y (ite (<= x 0.0) 1.0 2.0)))"
          "(fact (<= y 1.5))(search (x y) \".\")"));
}

// What is too large is rejected, in little time and memory.
TEST(Certify, EndsOnAnything) {
  const auto said = [](const std::string& text) { return Rejected(kHead + text); };
  EXPECT_EQ(said("(assert (< x 1.0))(search () \".\")"), "box 1 of the search is not empty");
  EXPECT_EQ(said("(declare-fun p () Bool)(substitute b (ite b p p))"),
            "only variables are substituted, by numbers");
  EXPECT_EQ(said("(define-fun f ((a Real)) Real (f a))(assert (< (f 1.0) 0.0))"),
            "too many uses of definitions");
  const auto chain = [](const std::string& first, const std::string& next, int count) {
    std::string text = "(let $p0 " + first + ")";
    for (int i = 1; i <= count; ++i) {
      std::string step = next;
      for (size_t at = step.find('@'); at != std::string::npos; at = step.find('@'))
        step.replace(at, 1, "$p" + std::to_string(i - 1));
      text += "(let $p" + std::to_string(i) + " " + step + ")";
    }
    return text + "(fact (<= $p" + std::to_string(count) + " 0.0))";
  };
  EXPECT_EQ(said(chain("x", "(* @ @)", 40)), "this product has too many factors");
  EXPECT_EQ(said(chain("3.0", "(* @ @)", 45)), "this number is too large");
  EXPECT_EQ(said(chain("(sqrt x)", "(+ (sin @) (cos @))", 60)), "this does not follow from what is known");
  EXPECT_EQ(said(chain("x", "(sin @)", 900)), "functions are nested too deeply");
  std::string roots = "x";
  for (int i = 0; i < 45; ++i) roots = "(sqrt " + roots + ")";
  EXPECT_EQ(said("(assert (<= " + roots + " 3.0))(contradiction)"), "no contradiction is known here");
}

}  // namespace
}  // namespace rondo::solve
