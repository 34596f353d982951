// Instantiation loses answers, never invents them: what it makes unsatisfiable is so.
#include "solve/instantiate.h"

#include <gtest/gtest.h>

#include "expr/lists.h"
#include "solve/z3/z3_solver.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::TermId;

class Instantiation : public testing::Test {
 protected:
  TermId Const(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  bool IsUnsat(const std::vector<Assertion>& assertions) {
    return std::holds_alternative<Unsat>(z3::Z3Solver().Check({&arena_, assertions, {}}, {}, {}));
  }
  Ground Run(const std::vector<Assertion>& assertions) { return Instantiate(arena_, assertions, {}); }

  Arena arena_;
  expr::SortId bools_ = arena_.Array(arena_.Int(), arena_.Bool());
};

TEST_F(Instantiation, UsesTheIndicesThatOccur) {
  const TermId v = Const("v", bools_);
  const TermId i = Const("i", arena_.Int());
  const TermId k = arena_.FreshBound("k", arena_.Int());
  const std::vector<Assertion> assertions{{arena_.Forall({k}, arena_.Select(v, k)), "all"},
                                          {arena_.Not(arena_.Select(v, i)), ""}};
  EXPECT_TRUE(IsUnsat(Run(assertions).assertions));
}

TEST_F(Instantiation, FollowsOffsets) {
  const TermId v = Const("v", bools_);
  const TermId i = Const("i", arena_.Int());
  const TermId k = arena_.FreshBound("k", arena_.Int());
  const TermId next = arena_.Select(v, arena_.Add(k, arena_.IntNumber(1)));
  const std::vector<Assertion> assertions{{arena_.Forall({k}, next), ""},
                                          {arena_.Not(arena_.Select(v, i)), ""}};
  EXPECT_TRUE(IsUnsat(Run(assertions).assertions));
}

TEST_F(Instantiation, HandlesBothPolaritiesUnderEquality) {
  const TermId v = Const("v", bools_);
  const TermId w = Const("w", bools_);
  const TermId p = Const("p", arena_.Bool());
  const auto all = [&](TermId array) {
    const TermId k = arena_.FreshBound("k", arena_.Int());
    return arena_.Forall({k}, arena_.Select(array, k));
  };
  // p = (all of v), p, and some v is false: contradiction through the positive direction.
  const TermId i = Const("i", arena_.Int());
  EXPECT_TRUE(
      IsUnsat(Run({{arena_.Eq(p, all(v)), ""}, {p, ""}, {arena_.Not(arena_.Select(v, i)), ""}}).assertions));
  // Not p needs a false item; satisfiable, so it must not be refuted.
  EXPECT_FALSE(IsUnsat(Run({{arena_.Eq(p, all(w)), ""}, {arena_.Not(p), ""}}).assertions));
}

TEST_F(Instantiation, NeverRefutesWhatIsSatisfiable) {
  const TermId v = Const("v", bools_);
  const TermId k = arena_.FreshBound("k", arena_.Int());
  const TermId m = arena_.FreshBound("m", arena_.Int());
  // For each k there is an m with v[m] != v[k]: true of any array with two values.
  const TermId formula =
      arena_.Forall({k}, arena_.Exists({m}, arena_.Not(arena_.Eq(arena_.Select(v, m), arena_.Select(v, k)))));
  const Ground ground = Run({{formula, ""}, {arena_.Select(v, arena_.IntNumber(0)), ""}});
  EXPECT_FALSE(ground.complete);
  EXPECT_FALSE(IsUnsat(ground.assertions));
}

TEST_F(Instantiation, MatchesTriggers) {
  const expr::SortId path = arena_.Opaque("Path");
  const expr::SymbolId d = arena_.Declare("d", {path, path}, arena_.Real());
  const TermId p = arena_.FreshBound("p", path);
  const TermId q = arena_.FreshBound("q", path);
  const TermId a = Const("a", path);
  const TermId b = Const("b", path);
  const TermId symmetric = arena_.Forall({p, q}, arena_.Eq(arena_.Apply(d, {p, q}), arena_.Apply(d, {q, p})));
  const std::vector<Assertion> assertions{{symmetric, "symmetric"},
                                          {arena_.Lt(arena_.Apply(d, {a, b}), arena_.Apply(d, {b, a})), ""}};
  const Ground ground = Run(assertions);
  EXPECT_TRUE(IsUnsat(ground.assertions));
  EXPECT_LE(ground.assertions.size(), 5u);  // not one instance for each pair of terms
}

TEST_F(Instantiation, ListsBehaveLikeLists) {
  const TermId l = Const("l", arena_.List(arena_.Int()));
  const TermId e = Const("e", arena_.Int());
  const auto is_unsat = [&](TermId claim) {
    std::vector<Assertion> assertions{{claim, ""}};
    std::unordered_set<TermId> done;
    for (int pass = 0; pass < 4; ++pass) {
      const Ground ground = Run(assertions);
      std::vector<TermId> formulas;
      for (const Assertion& a : ground.assertions) formulas.push_back(a.formula);
      const auto axioms = expr::ListAxioms(arena_, formulas, done);
      if (axioms.empty()) return IsUnsat(ground.assertions);
      for (const TermId axiom : axioms) assertions.push_back({axiom, ""});
    }
    return IsUnsat(Run(assertions).assertions);
  };
  const TermId length = arena_.Length(l);
  const TermId longer = arena_.Append(l, e);
  const TermId removed = arena_.Remove(l, e);
  const TermId zero = arena_.IntNumber(0);
  EXPECT_TRUE(
      is_unsat(arena_.Not(arena_.Eq(arena_.Length(longer), arena_.Add(length, arena_.IntNumber(1))))));
  EXPECT_TRUE(is_unsat(arena_.Not(arena_.Eq(arena_.At(longer, length), e))));
  EXPECT_TRUE(is_unsat(arena_.Lt(length, arena_.Length(removed))));
  EXPECT_TRUE(is_unsat(arena_.Lt(length, zero)));
  // Removing may shorten, or may change nothing.
  EXPECT_FALSE(is_unsat(arena_.Lt(arena_.Length(removed), length)));
  EXPECT_FALSE(is_unsat(arena_.Eq(arena_.Length(removed), length)));
  const TermId one = arena_.IntNumber(1);
  const TermId two = arena_.IntNumber(2);
  const auto long_enough = [&](TermId claim) { return arena_.And(arena_.Le(two, length), claim); };
  const auto differ = [&](TermId a, TermId b) { return arena_.Not(arena_.Eq(a, b)); };
  // What is inserted is there, what stood there stands behind it, and the rest stays.
  const TermId inserted = arena_.Insert(l, one, e);
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.Length(inserted), arena_.Add(length, one)))));
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.At(inserted, one), e))));
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.At(inserted, zero), arena_.At(l, zero)))));
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.At(inserted, two), arena_.At(l, one)))));
  EXPECT_FALSE(is_unsat(long_enough(differ(arena_.At(inserted, one), arena_.At(l, one)))));
  const TermId dropped = arena_.Drop(l, zero);
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.Length(dropped), arena_.Sub(length, one)))));
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.At(dropped, zero), arena_.At(l, one)))));
  EXPECT_FALSE(is_unsat(long_enough(differ(arena_.At(dropped, zero), arena_.At(l, zero)))));
  const TermId slice = arena_.Slice(l, one, two);
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.Length(slice), one))));
  EXPECT_TRUE(is_unsat(long_enough(differ(arena_.At(slice, zero), arena_.At(l, one)))));
  EXPECT_FALSE(is_unsat(long_enough(differ(slice, l))));
  // What is impossible changes nothing.
  EXPECT_TRUE(is_unsat(arena_.And(arena_.Lt(length, one), differ(dropped, l))));
  const TermId changed = arena_.Set(l, zero, e);
  EXPECT_TRUE(
      is_unsat(arena_.And(arena_.Lt(zero, length), arena_.Not(arena_.Eq(arena_.At(changed, zero), e)))));
}

}  // namespace
}  // namespace rondo::solve
