#include "solve/icp/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "expr/numeric.h"
#include "solve/icp/prepare/real_variables_test.h"

namespace rondo::solve::icp {
namespace {

using Kind = SearchResult::Kind;

class Searches : public RealVariables {
 protected:
  // Nothing but the formula, and bounds of all variables in it.
  Tape TapeOf(TermId formula, int lo = -2, int hi = 2) {
    Prepared prepared;
    prepared.disjunctions = {formula};
    for (const TapeVariable& v : BuildTape(arena_, variables_, prepared).variables) {
      prepared.ranges[v.term].Add(kGreater | kEqual, lo);
      prepared.ranges[v.term].Add(kLess | kEqual, hi);
    }
    return BuildTape(arena_, variables_, prepared);
  }
  double Violation(const Tape& tape, const std::vector<double>& point, TermId formula) {
    expr::Numeric::Point at;
    for (size_t v = 0; v < point.size(); ++v) at[tape.variables[v].term] = point[v];
    return expr::Numeric(arena_, at).Violation(formula);
  }
  SearchOptions Options() {
    SearchOptions options;
    options.kernels = &interval::BestKernels();
    options.precision = 1e-3;
    options.verify = [](const std::vector<double>&) { return false; };
    return options;
  }
  // A disc and what lies beyond a line that misses it.
  TermId Apart() {
    return arena_.And(arena_.Le(arena_.Add(xx_, yy_), Number("1")),
                      arena_.Le(Number("1.5"), arena_.Add(x_, y_)));
  }

  const TermId x_ = Variable("x", icp::Variable::Kind::kReal), y_ = Variable("y", icp::Variable::Kind::kReal);
  const TermId n_ = Variable("n", icp::Variable::Kind::kInt);
  const TermId xx_ = arena_.Mul(x_, x_), yy_ = arena_.Mul(y_, y_);
};

TEST_F(Searches, WhatHasNoSolutionIsEmpty) {
  EXPECT_EQ(Search(TapeOf(Apart()), Options()).kind, Kind::kEmpty);
}

TEST_F(Searches, EmptinessDoesNotDependOnThreads) {
  for (const unsigned jobs : {1u, 2u, 5u}) {
    SearchOptions options = Options();
    options.jobs = jobs;
    EXPECT_EQ(Search(TapeOf(Apart()), options).kind, Kind::kEmpty) << jobs;
  }
}

TEST_F(Searches, EveryBackEndFindsItEmpty) {
  for (const interval::Backend backend : interval::AvailableBackends()) {
    SearchOptions options = Options();
    options.kernels = &interval::KernelsOf(backend);
    EXPECT_EQ(Search(TapeOf(Apart()), options).kind, Kind::kEmpty) << options.kernels->name;
  }
}

TEST_F(Searches, ThePointIsOneThatWasVerified) {
  const TermId f =
      arena_.And(arena_.Le(arena_.Add(xx_, yy_), Number("1")), arena_.Le(Number("1.3"), arena_.Add(x_, y_)));
  const Tape tape = TapeOf(f);
  for (const unsigned jobs : {1u, 3u}) {
    SearchOptions options = Options();
    options.jobs = jobs;
    options.verify = [&](const std::vector<double>& point) { return Violation(tape, point, f) == 0; };
    const SearchResult result = Search(tape, options);
    ASSERT_EQ(result.kind, Kind::kPoint);
    EXPECT_EQ(Violation(tape, result.point, f), 0);
  }
}

TEST_F(Searches, WithoutAVerifiedPointASmallBoxIsLeft) {
  const TermId f = arena_.And(arena_.Eq(xx_, Number("2")), arena_.Lt(Number("0"), x_));
  const Tape tape = TapeOf(f);
  const SearchResult result = Search(tape, Options());
  ASSERT_EQ(result.kind, Kind::kUndecided);
  ASSERT_EQ(result.box.size(), 2u);
  EXPECT_LE(result.box[0], std::sqrt(2));
  EXPECT_GE(result.box[1], std::sqrt(2));
  EXPECT_LE(result.box[1] - result.box[0], 1e-3 * 2);
}

TEST_F(Searches, IntegersAreSplitBetweenEachOther) {
  const TermId square = arena_.Mul(n_, n_), mixed = arena_.Add(square, n_);
  EXPECT_EQ(Search(TapeOf(arena_.Eq(mixed, Number("50")), 0, 20), Options()).kind, Kind::kEmpty);
  const TermId f = arena_.Eq(mixed, Number("56"));
  const Tape tape = TapeOf(f, 0, 20);
  SearchOptions options = Options();
  options.verify = [&](const std::vector<double>& point) { return Violation(tape, point, f) == 0; };
  const SearchResult result = Search(tape, options);
  ASSERT_EQ(result.kind, Kind::kPoint);
  EXPECT_EQ(result.point, std::vector<double>{7});
}

TEST_F(Searches, AStoppedSearchGivesUp) {
  SearchOptions options = Options();
  options.stop.RequestStop();
  EXPECT_EQ(Search(TapeOf(arena_.Eq(arena_.Mul(xx_, y_), Number("1"))), options).kind, Kind::kGaveUp);
}

TEST_F(Searches, TooManyBoxesAreGivenUp) {
  SearchOptions options = Options();
  options.max_boxes = 3;
  const SearchResult result = Search(TapeOf(arena_.Eq(arena_.Mul(xx_, y_), Number("1"))), options);
  EXPECT_EQ(result.kind, Kind::kGaveUp);
  EXPECT_LE(result.boxes, 20u);
}

TEST_F(Searches, TheTreeOfARefutationDividesTheBox) {
  SearchOptions options = Options();
  options.record_tree = true;
  const Tape tape = TapeOf(Apart());
  const SearchResult result = Search(tape, options);
  ASSERT_EQ(result.kind, Kind::kEmpty);
  ASSERT_FALSE(result.tree.empty());
  std::vector<bool> reached(result.tree.size());
  std::vector<std::pair<uint32_t, FlatBox>> open{{0, {-2, 2, -2, 2}}};
  while (!open.empty()) {
    const auto [id, box] = open.back();
    open.pop_back();
    reached[id] = true;
    const TreeNode& node = result.tree[id];
    if (node.first_child == 0) continue;
    ASSERT_LT(node.first_child + 1, result.tree.size());
    ASSERT_LT(node.variable, 2u);
    EXPECT_TRUE(box[2 * node.variable] < node.value && node.value < box[2 * node.variable + 1]);
    FlatBox below = box, above = box;
    below[2 * node.variable + 1] = above[2 * node.variable] = node.value;
    open.insert(open.end(), {{node.first_child, below}, {node.first_child + 1, above}});
  }
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST_F(Searches, TreesAreRecordedOnDemand) { EXPECT_TRUE(Search(TapeOf(Apart()), Options()).tree.empty()); }

TEST_F(Searches, TheContractedRootKeepsSolutions) {
  const TermId f = arena_.And(arena_.Le(arena_.Add(xx_, yy_), Number("0.25")), arena_.Le(x_, y_));
  const auto box = ContractRoot(TapeOf(f), interval::BestKernels());
  ASSERT_TRUE(box.has_value());
  for (const auto& [lo, hi] : {std::pair((*box)[0], (*box)[1]), std::pair((*box)[2], (*box)[3])}) {
    EXPECT_LE(lo, -0.35);
    EXPECT_GE(hi, 0.35);
    EXPECT_GE(lo, -0.51);
    EXPECT_LE(hi, 0.51);
  }
}

TEST_F(Searches, AnEmptyRootIsNoBox) {
  EXPECT_FALSE(ContractRoot(TapeOf(arena_.Lt(xx_, Number("-1"))), interval::BestKernels()));
}

}  // namespace
}  // namespace rondo::solve::icp
