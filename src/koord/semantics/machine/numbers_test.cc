#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "koord/semantics/machine/machine.h"

namespace rondo::koord::semantics {
namespace {

constexpr int64_t kMin = std::numeric_limits<int64_t>::min();
constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
constexpr double kHuge = std::numeric_limits<double>::max();

struct Outcome {
  Fault fault = Fault::kNone;
  bool used_default = false;
  std::vector<Word> words;

  int64_t integer() const { return words.size() == 1 ? ToInt(words[0]) : 0x5555; }
  double real() const { return words.size() == 1 ? ToFloat(words[0]) : std::nan(""); }
  bool truth() const { return words == std::vector<Word>{1}; }
};

// Pushes the words, the first one deepest, and runs one instruction for a team of two robots.
Outcome Execute(std::vector<Word> stack, const Instruction& instruction, bool total = false) {
  Code code;
  code.constants = std::move(stack);
  for (uint32_t i = 0; i < code.constants.size(); ++i) code.instructions.push_back({Op::kConstant, i});
  code.instructions.push_back(instruction);
  code.instructions.push_back({Op::kEnd});
  code.spans.resize(code.instructions.size());
  Model model;
  const Layout layout(model, 2, {});
  Heap heap;
  Machine machine(code, layout, heap);
  std::vector<Word> memory(layout.words());
  machine.SetMemory(memory.data());
  machine.Run(0, 0, total);
  return {machine.fault(), machine.used_default(), {machine.result().begin(), machine.result().end()}};
}

Outcome Ints(Op op, int64_t a, int64_t b, bool total = false) {
  return Execute({FromInt(a), FromInt(b)}, {op}, total);
}
Outcome Floats(Op op, double a, double b, bool total = false) {
  return Execute({FromFloat(a), FromFloat(b)}, {op}, total);
}
std::vector<Word> Words(const std::vector<double>& values) {
  std::vector<Word> words;
  for (const double x : values) words.push_back(FromFloat(x));
  return words;
}

TEST(Integers, AdditionFaultsInsteadOfWrapping) {
  EXPECT_EQ(Ints(Op::kAddInt, kMax, 0).integer(), kMax);
  EXPECT_EQ(Ints(Op::kAddInt, kMax, 1).fault, Fault::kOverflow);
  EXPECT_EQ(Ints(Op::kAddInt, kMin, -1).fault, Fault::kOverflow);
}

TEST(Integers, SubtractionFaultsInsteadOfWrapping) {
  EXPECT_EQ(Ints(Op::kSubInt, 3, 5).integer(), -2);
  EXPECT_EQ(Ints(Op::kSubInt, -1, kMax).integer(), kMin);
  EXPECT_EQ(Ints(Op::kSubInt, -2, kMax).fault, Fault::kOverflow);
  EXPECT_EQ(Ints(Op::kSubInt, 0, kMin).fault, Fault::kOverflow);
}

TEST(Integers, MultiplicationFaultsInsteadOfWrapping) {
  EXPECT_EQ(Ints(Op::kMulInt, kMin / 2, 2).integer(), kMin);
  EXPECT_EQ(Ints(Op::kMulInt, kMin / 2, -2).fault, Fault::kOverflow);
  EXPECT_EQ(Ints(Op::kMulInt, int64_t{1} << 32, int64_t{1} << 31).fault, Fault::kOverflow);
}

TEST(Integers, TheLeastOneHasNoNegative) {
  EXPECT_EQ(Execute({FromInt(kMin)}, {Op::kNegInt}).fault, Fault::kOverflow);
  EXPECT_EQ(Execute({FromInt(kMin)}, {Op::kAbsInt}).fault, Fault::kOverflow);
  EXPECT_EQ(Execute({FromInt(kMin + 1)}, {Op::kNegInt}).integer(), kMax);
  EXPECT_EQ(Execute({FromInt(kMin + 1)}, {Op::kAbsInt}).integer(), kMax);
  EXPECT_EQ(Execute({FromInt(7)}, {Op::kAbsInt}).integer(), 7);
}

TEST(Integers, DivisionIsEuclidean) {
  EXPECT_EQ(Ints(Op::kDivInt, -7, 2).integer(), -4);
  EXPECT_EQ(Ints(Op::kDivInt, 7, -2).integer(), -3);
  EXPECT_EQ(Ints(Op::kDivInt, -7, -2).integer(), 4);
  EXPECT_EQ(Ints(Op::kModInt, -7, 2).integer(), 1);
  EXPECT_EQ(Ints(Op::kModInt, -7, -2).integer(), 1);
}

TEST(Integers, QuotientAndRemainderGiveTheDividendBack) {
  for (int64_t a = -9; a <= 9; ++a) {
    for (int64_t b = -4; b <= 4; ++b) {
      if (b == 0) continue;
      const int64_t rest = Ints(Op::kModInt, a, b).integer();
      EXPECT_EQ(b * Ints(Op::kDivInt, a, b).integer() + rest, a) << a << " " << b;
      EXPECT_TRUE(0 <= rest && rest < std::abs(b)) << a << " " << b;
    }
  }
}

TEST(Integers, DivisionAtTheEdgeOf64Bits) {
  EXPECT_EQ(Ints(Op::kDivInt, kMin, -1).fault, Fault::kOverflow);
  EXPECT_EQ(Ints(Op::kModInt, kMin, -1).integer(), 0);
  EXPECT_EQ(Ints(Op::kDivInt, kMin, kMax).integer(), -2);
  EXPECT_EQ(Ints(Op::kModInt, kMin, kMax).integer(), kMax - 1);
  EXPECT_EQ(Ints(Op::kDivInt, -1, kMin).integer(), 1);
  EXPECT_EQ(Ints(Op::kModInt, -1, kMin).integer(), kMax);
}

TEST(Integers, DivisionByZeroIsAFaultInEvents) {
  EXPECT_EQ(Ints(Op::kDivInt, 1, 0).fault, Fault::kDivision);
  EXPECT_EQ(Ints(Op::kModInt, 1, 0).fault, Fault::kDivision);
}

TEST(Integers, DivisionByZeroIsZeroInFormulas) {
  for (const Op op : {Op::kDivInt, Op::kModInt}) {
    const Outcome outcome = Ints(op, 5, 0, true);
    EXPECT_EQ(outcome.fault, Fault::kNone);
    EXPECT_EQ(outcome.integer(), 0);
    EXPECT_TRUE(outcome.used_default);
  }
  EXPECT_FALSE(Ints(Op::kDivInt, 5, 2, true).used_default);
}

TEST(Integers, ComparisonsKnowTheSign) {
  EXPECT_TRUE(Ints(Op::kLessInt, -1, 0).truth());
  EXPECT_FALSE(Ints(Op::kLessInt, 0, -1).truth());
  EXPECT_FALSE(Ints(Op::kLessInt, 3, 3).truth());
  EXPECT_TRUE(Ints(Op::kLessEqualInt, 3, 3).truth());
  EXPECT_FALSE(Ints(Op::kLessEqualInt, 4, 3).truth());
}

TEST(Integers, MinimumAndMaximumKnowTheSign) {
  EXPECT_EQ(Ints(Op::kMinInt, 2, -3).integer(), -3);
  EXPECT_EQ(Ints(Op::kMaxInt, 2, -3).integer(), 2);
}

TEST(Doubles, AreAlwaysFinite) {
  EXPECT_EQ(Floats(Op::kAddFloat, kHuge, kHuge).fault, Fault::kOverflow);
  EXPECT_EQ(Floats(Op::kSubFloat, -kHuge, kHuge).fault, Fault::kOverflow);
  EXPECT_EQ(Floats(Op::kMulFloat, 1e200, -1e200).fault, Fault::kOverflow);
  EXPECT_EQ(Floats(Op::kDivFloat, 1e200, 1e-200).fault, Fault::kOverflow);
}

TEST(Doubles, ArithmeticIsThatOfIeee) {
  EXPECT_EQ(Floats(Op::kAddFloat, 0.1, 0.2).real(), 0.1 + 0.2);
  EXPECT_EQ(Floats(Op::kSubFloat, 1, 0.25).real(), 0.75);
  EXPECT_EQ(Floats(Op::kMulFloat, -3, 0.5).real(), -1.5);
  EXPECT_EQ(Floats(Op::kDivFloat, 1, 3).real(), 1.0 / 3);
  EXPECT_EQ(Execute({FromFloat(-2.5)}, {Op::kAbsFloat}).real(), 2.5);
}

TEST(Doubles, ZeroHasOneSign) {
  const std::vector<Word> zero{FromFloat(0.0)};
  EXPECT_EQ(Execute({FromFloat(0)}, {Op::kNegFloat}).words, zero);
  EXPECT_EQ(Floats(Op::kMulFloat, 0, -1).words, zero);
  EXPECT_EQ(Floats(Op::kDivFloat, 0, -4).words, zero);
}

TEST(Doubles, DivisionByZeroIsAFaultOrZero) {
  EXPECT_EQ(Floats(Op::kDivFloat, 1, 0).fault, Fault::kDivision);
  const Outcome outcome = Floats(Op::kDivFloat, 1, 0, true);
  EXPECT_EQ(outcome.real(), 0);
  EXPECT_TRUE(outcome.used_default);
}

TEST(Doubles, AreCompared) {
  EXPECT_TRUE(Floats(Op::kLessFloat, -2, -1.5).truth());
  EXPECT_FALSE(Floats(Op::kLessFloat, 1.5, 1.5).truth());
  EXPECT_TRUE(Floats(Op::kLessEqualFloat, 1.5, 1.5).truth());
  EXPECT_FALSE(Floats(Op::kLessEqualFloat, -1.5, -2).truth());
  EXPECT_EQ(Floats(Op::kMinFloat, -1, 2).real(), -1);
  EXPECT_EQ(Floats(Op::kMaxFloat, -1, 2).real(), 2);
}

TEST(Doubles, ComeFromIntegers) {
  EXPECT_EQ(Execute({FromInt(-3)}, {Op::kToFloat}).real(), -3);
  EXPECT_EQ(Execute({FromInt(kMax)}, {Op::kToFloat}).real(), 0x1p63);
}

TEST(Points, AreAddedAndScaledByCoordinate) {
  EXPECT_EQ(Execute(Words({1, 2, 3, 10, 20, 30}), {Op::kAddPos}).words, Words({11, 22, 33}));
  EXPECT_EQ(Execute(Words({1, 2, 3, 10, 20, 30}), {Op::kSubPos}).words, Words({-9, -18, -27}));
  EXPECT_EQ(Execute(Words({1, 2, 3, 2, 2, 2}), {Op::kMulPos}).words, Words({2, 4, 6}));
  EXPECT_EQ(Execute(Words({1, 2, 3, 2, 4, 8}), {Op::kDivPos}).words, Words({0.5, 0.5, 0.375}));
  EXPECT_EQ(Execute(Words({1, 0, -3}), {Op::kNegPos}).words, Words({-1, 0, 3}));
}

TEST(Points, HaveAMiddleAndADistance) {
  EXPECT_EQ(Execute(Words({0, 2, -4, 2, 4, 4}), {Op::kMidPos}).words, Words({1, 3, 0}));
  EXPECT_EQ(Execute(Words({1, 1, 1, 3, 4, 7}), {Op::kDistPos}).real(), 7);
}

TEST(Points, AreFinite) {
  EXPECT_EQ(Execute(Words({0, 0, kHuge, 0, 0, kHuge}), {Op::kAddPos}).fault, Fault::kOverflow);
  EXPECT_EQ(Execute(Words({kHuge, 0, 0, -kHuge, 0, 0}), {Op::kDistPos}).fault, Fault::kOverflow);
}

TEST(Points, NoCoordinateIsDividedByZero) {
  EXPECT_EQ(Execute(Words({1, 2, 3, 1, 1, 0}), {Op::kDivPos}).fault, Fault::kDivision);
  EXPECT_EQ(Execute(Words({1, 2, 3, 0, 1, 1}), {Op::kDivPos}).fault, Fault::kDivision);
  const Outcome outcome = Execute(Words({1, 2, 3, 0, 0, 0}), {Op::kDivPos}, true);
  EXPECT_EQ(outcome.words, Words({0, 0, 0}));
  EXPECT_TRUE(outcome.used_default);
}

TEST(Points, ARectangleContainsItsEdges) {
  const auto inside = [](double x, double y, double z) {
    return Execute(Words({x, y, z, 0, 0, 0, 1, 2, 3}), {Op::kInRect}).truth();
  };
  EXPECT_TRUE(inside(0, 0, 0));
  EXPECT_TRUE(inside(1, 2, 3));
  EXPECT_FALSE(inside(1.5, 1, 1));
  EXPECT_FALSE(inside(0.5, -0.1, 1));
  EXPECT_FALSE(inside(0.5, 1, 3.1));
}

TEST(Points, AFloatBecomesThreeEqualCoordinates) {
  EXPECT_EQ(Execute(Words({2.5}), {Op::kSplat}).words, Words({2.5, 2.5, 2.5}));
}

TEST(Comparisons, ValuesAreEqualIfAllTheirWordsAre) {
  EXPECT_TRUE(Execute({1, 2, 3, 1, 2, 3}, {Op::kEqual, 3}).truth());
  EXPECT_FALSE(Execute({1, 2, 3, 1, 2, 4}, {Op::kEqual, 3}).truth());
  EXPECT_FALSE(Execute({1, 2, 3, 0, 2, 3}, {Op::kEqual, 3}).truth());
}

TEST(Comparisons, NegationOfATruthValue) {
  EXPECT_TRUE(Execute({0}, {Op::kNot}).truth());
  EXPECT_FALSE(Execute({1}, {Op::kNot}).truth());
}

TEST(Comparisons, OnlyNumbersOfTheTeamAreRobots) {
  EXPECT_FALSE(Execute({FromInt(-1)}, {Op::kIsRobot}).truth());
  EXPECT_TRUE(Execute({0}, {Op::kIsRobot}).truth());
  EXPECT_TRUE(Execute({1}, {Op::kIsRobot}).truth());
  EXPECT_FALSE(Execute({2}, {Op::kIsRobot}).truth());
}

}  // namespace
}  // namespace rondo::koord::semantics
