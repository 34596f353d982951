#include "solve/places.h"

#include <gtest/gtest.h>

#include <set>

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::Op;
using expr::Rational;
using expr::TermId;
using Terms = std::vector<TermId>;

class Places : public testing::Test {
 protected:
  TermId Constant(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  TermId F(TermId t) { return arena_.Apply(f_, Terms{t}); }
  TermId G(TermId t, TermId u) { return arena_.Apply(g_, Terms{t, u}); }
  TermId Equals(TermId t, int64_t n) { return arena_.Eq(t, arena_.IntNumber(n)); }
  Place PlaceOf(expr::SymbolId f, uint32_t position) { return {Op::kApply, f.value, position}; }

  Arena arena_;
  const expr::SortId int_ = arena_.Int();
  const expr::SymbolId f_ = arena_.Declare("f", {int_}, int_), g_ = arena_.Declare("g", {int_, int_}, int_);
  const TermId a_ = Constant("a", int_), b_ = Constant("b", int_), i_ = arena_.FreshBound("i", int_);
};

TEST_F(Places, ArgumentsStandAtTheirPlaces) {
  PlaceIndex index(arena_);
  index.Add(Equals(G(a_, F(b_)), 1));
  EXPECT_EQ(index.At(PlaceOf(g_, 0)), Terms{a_});
  EXPECT_EQ(index.At(PlaceOf(g_, 1)), Terms{F(b_)});
  EXPECT_EQ(index.At(PlaceOf(f_, 0)), Terms{b_});
}

TEST_F(Places, EachTermIsKnownOnceInOrder) {
  PlaceIndex index(arena_);
  index.Add(Equals(F(b_), 1));
  index.Add(arena_.Or(Equals(F(a_), 2), Equals(F(b_), 3)));
  EXPECT_EQ(index.At(PlaceOf(f_, 0)), (Terms{b_, a_}));
  EXPECT_EQ(index.Applications(f_), (Terms{F(b_), F(a_)}));
}

TEST_F(Places, OpenTermsStandNowhere) {
  PlaceIndex index(arena_);
  index.Add(arena_.Forall({i_}, arena_.Or(Equals(F(i_), 1), Equals(F(a_), 2))));
  EXPECT_EQ(index.At(PlaceOf(f_, 0)), Terms{a_});
  EXPECT_EQ(index.Applications(f_), Terms{F(a_)});
}

TEST_F(Places, NothingIsKnownOfOtherPlaces) {
  PlaceIndex index(arena_);
  index.Add(Equals(F(a_), 1));
  EXPECT_TRUE(index.At(PlaceOf(g_, 0)).empty());
  EXPECT_TRUE(index.Applications(g_).empty());
}

TEST_F(Places, IndicesBelongToAllArraysOfATerm) {
  const expr::SortId sort = arena_.Array(int_, int_);
  const TermId p = Constant("p", sort), q = Constant("q", sort), c = Constant("c", arena_.Bool());
  const TermId mixed = arena_.Ite(c, arena_.Store(p, b_, a_), q);
  PlaceIndex index(arena_);
  index.Add(Equals(arena_.Select(mixed, a_), 1));
  const auto at = [&](TermId array) { return index.At({Op::kSelect, arena_.symbol_of(array).value, 1}); };
  const Terms of_p = at(p);
  EXPECT_EQ(std::set<TermId>(of_p.begin(), of_p.end()), (std::set<TermId>{a_, b_}));
  EXPECT_EQ(at(q), Terms{a_});
}

TEST_F(Places, VariablesHavePlacesWithOffsets) {
  const TermId shifted = arena_.Add(i_, arena_.IntNumber(3));
  const auto places = PlacesOf(arena_, arena_.Or(Equals(G(i_, a_), 0), Equals(F(shifted), 0)), {i_});
  ASSERT_EQ(places.at(i_).size(), 2u);
  for (const VariablePlace& p : places.at(i_)) {
    const bool plain = p.place == PlaceOf(g_, 0);
    EXPECT_TRUE(plain || p.place == PlaceOf(f_, 0));
    EXPECT_EQ(p.offset, Rational(plain ? 0 : 3));
  }
}

TEST_F(Places, OtherVariablesHaveNone) {
  const TermId j = arena_.FreshBound("j", int_);
  const auto places = PlacesOf(arena_, arena_.Or(Equals(F(i_), 0), Equals(F(j), 0)), {j});
  EXPECT_FALSE(places.contains(i_));
  EXPECT_TRUE(places.contains(j));
}

TEST_F(Places, ComparedNumbersAreEqualTerms) {
  const TermId body = arena_.Or(arena_.Not(arena_.Eq(i_, b_)), arena_.Or(Equals(i_, 7), Equals(F(i_), 9)));
  const auto equal = EqualTerms(arena_, body, {i_});
  const Terms& terms = equal.at(i_);
  EXPECT_EQ(std::set<TermId>(terms.begin(), terms.end()), (std::set<TermId>{b_, arena_.IntNumber(7)}));
}

TEST_F(Places, OnlyNumbersHaveEqualTerms) {
  const expr::SortId robot = arena_.Opaque("Robot");
  const TermId r = arena_.FreshBound("r", robot);
  EXPECT_TRUE(EqualTerms(arena_, arena_.Eq(r, Constant("s", robot)), {r}).empty());
}

TEST_F(Places, OpenTermsAreNoEqualTerms) {
  const TermId j = arena_.FreshBound("j", int_);
  EXPECT_TRUE(EqualTerms(arena_, arena_.Eq(i_, F(j)), {i_, j}).empty());
}

}  // namespace
}  // namespace rondo::solve
