#include <gtest/gtest.h>

#include "solve/icp/tape/tape.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;

class Singles : public testing::Test {
 protected:
  TermId Variable(const char* name) {
    const TermId v = arena_.Variable(arena_.Declare(name, {}, arena_.Real()));
    variables_.emplace(v, icp::Variable{v, icp::Variable::Kind::kReal});
    return v;
  }
  TermId Sin(TermId t) { return arena_.Apply(Elementary::kSin, {t}); }
  TermId Exp(TermId t) { return arena_.Apply(Elementary::kExp, {t}); }
  // Is it no use to split the variable, if these terms are compared with something?
  bool Single(TermId variable, const std::vector<TermId>& compared) {
    Prepared prepared;
    for (const TermId t : compared) prepared.ranges[t].Add(kLess, 1);
    for (const TapeVariable& v : BuildTape(arena_, variables_, prepared).variables) {
      if (v.term == variable) return v.single;
    }
    ADD_FAILURE() << "the variable does not occur";
    return false;
  }

  expr::Arena arena_;
  std::unordered_map<TermId, icp::Variable> variables_;
  const TermId x_ = Variable("x"), y_ = Variable("y"), z_ = Variable("z");
};

TEST_F(Singles, WhatIsUsedOnceNeedsNoSplit) {
  EXPECT_TRUE(Single(x_, {arena_.Add(x_, Sin(y_))}));
  EXPECT_TRUE(Single(x_, {arena_.Mul(Exp(x_), arena_.Add(y_, Sin(y_)))}));
}

TEST_F(Singles, WhatIsUsedTwiceIsSplit) {
  EXPECT_FALSE(Single(x_, {arena_.Add(x_, Sin(x_))}));
  EXPECT_FALSE(Single(x_, {arena_.Mul(x_, y_), Sin(x_)}));
}

TEST_F(Singles, WhatIsPartOfSomethingUsedTwiceIsSplit) {
  const TermId product = arena_.Mul(x_, y_);
  EXPECT_FALSE(Single(x_, {arena_.Add(Sin(product), Exp(product))}));
}

TEST_F(Singles, InASumWithWhatIsSplitItNeedsNone) {
  const TermId sum = arena_.Add(x_, y_);
  const std::vector<TermId> compared{arena_.Add(Sin(sum), Exp(sum)), Sin(y_), Exp(y_)};
  EXPECT_TRUE(Single(x_, compared));
  EXPECT_FALSE(Single(y_, compared));
}

TEST_F(Singles, OneOfTwoSummandsOfARepeatedSumIsSplit) {
  const TermId sum = arena_.Add(x_, y_);
  const std::vector<TermId> compared{arena_.Add(Sin(sum), Exp(sum))};
  EXPECT_FALSE(Single(x_, compared) && Single(y_, compared));
}

TEST_F(Singles, OperationsOfTwoNumbersAreBinary) {
  for (const NodeOp op : {NodeOp::kAdd, NodeOp::kSub, NodeOp::kMul, NodeOp::kDiv, NodeOp::kMin, NodeOp::kMax,
                          NodeOp::kAtan2, NodeOp::kChoose})
    EXPECT_TRUE(IsBinary(op));
  for (const NodeOp op : {NodeOp::kNeg, NodeOp::kSqr, NodeOp::kPow, NodeOp::kSin, NodeOp::kThreshold,
                          NodeOp::kAnd, NodeOp::kVariable, NodeOp::kConstant})
    EXPECT_FALSE(IsBinary(op));
}

}  // namespace
}  // namespace rondo::solve::icp
