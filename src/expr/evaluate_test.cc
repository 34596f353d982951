#include "expr/evaluate.h"

#include <gtest/gtest.h>

namespace rondo::expr {
namespace {

class Evaluation : public testing::Test {
 protected:
  TermId Const(const char* name, SortId sort) { return a_.Variable(a_.Declare(name, {}, sort)); }
  std::string Text(TermId t) const {
    const auto value = Evaluate(a_, t, [&](TermId leaf) -> std::optional<Value> {
      if (leaf == x_) return Value{*Rational::Parse("0.5")};
      if (leaf == i_) return Value{Rational(-7)};
      return std::nullopt;
    });
    return value ? ToString(*value) : "none";
  }

  Arena a_;
  TermId x_ = Const("x", a_.Real());
  TermId i_ = Const("i", a_.Int());
  TermId unknown_ = Const("unknown", a_.Bool());
};

TEST_F(Evaluation, IsExact) {
  EXPECT_EQ(Text(a_.Add(x_, a_.Number(a_.Real(), Rational(1) / Rational(3)))), "5/6");
  EXPECT_EQ(Text(a_.IntDiv(i_, a_.IntNumber(2))), "-4");
  EXPECT_EQ(Text(a_.Mod(i_, a_.IntNumber(2))), "1");
  EXPECT_EQ(Text(a_.Lt(a_.ToReal(i_), x_)), "true");
}

TEST_F(Evaluation, OneOperandMayDecide) {
  EXPECT_EQ(Text(a_.And(unknown_, a_.Lt(x_, a_.ToReal(i_)))), "false");
  EXPECT_EQ(Text(a_.Or(unknown_, a_.Lt(a_.ToReal(i_), x_))), "true");
  EXPECT_EQ(Text(a_.And(unknown_, a_.Lt(a_.ToReal(i_), x_))), "none");
}

TEST_F(Evaluation, HasNoValueForAZeroDivisor) {
  EXPECT_EQ(Text(a_.Divide(x_, a_.Sub(a_.ToReal(i_), a_.ToReal(i_)))), "none");
  EXPECT_EQ(Text(a_.Mod(i_, a_.Add(i_, a_.IntNumber(7)))), "none");
}

TEST_F(Evaluation, ReadsRecords) {
  const SortId pair = a_.Record("pair", {"first", "second"}, {a_.Int(), a_.Real()});
  const TermId record = a_.Ite(a_.Lt(x_, a_.ToReal(i_)), Const("other", pair), a_.MakeRecord(pair, {i_, x_}));
  EXPECT_EQ(Text(record), "(-7, 0.5)");
  EXPECT_EQ(Text(a_.Field(record, 1)), "0.5");
}

}  // namespace
}  // namespace rondo::expr
