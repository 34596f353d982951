// Every simplification of the term constructors preserves meaning: Z3 proves the plain term equal to the
// simplified one. A rewrite that never fires here fails the test as well.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "expr/arena.h"
#include "expr/evaluate.h"
#include "solve/z3/z3_solver.h"

namespace rondo::expr {
namespace {

class Rewrites : public testing::Test {
 protected:
  Rewrites() {
    arena_.observer = [this](Rewrite rewrite, TermId plain, TermId simple) {
      pairs_.push_back({rewrite, plain, simple});
    };
  }
  TermId Const(const char* name, SortId sort) { return arena_.Variable(arena_.Declare(name, {}, sort)); }

  // Exercises every constructor on terms that offer something to simplify.
  void Exercise() {
    Arena& a = arena_;
    const TermId p = Const("p", a.Bool());
    const TermId q = Const("q", a.Bool());
    const TermId i = Const("i", a.Int());
    const TermId j = Const("j", a.Int());
    const TermId x = Const("x", a.Real());
    const TermId y = Const("y", a.Real());
    const SortId colour = a.Enum("Colour", {"red", "green", "blue"});
    const SortId pair = a.Record("pair", {"first", "second"}, {a.Int(), a.Real()});
    const SortId array = a.Array(a.Int(), a.Real());
    const TermId v = Const("v", array);
    const TermId r = Const("r", pair);
    const TermId s = Const("s", pair);
    const auto n = [&](int64_t k) { return a.IntNumber(k); };
    const auto f = [&](const char* t) { return a.Number(a.Real(), *Rational::Parse(t)); };

    for (const TermId t : {a.True(), a.False(), a.Not(p), a.Le(i, j), a.Lt(x, y)}) a.Not(t);
    a.And({p, a.And(q, a.Le(i, j)), a.True(), p});
    a.Or({p, a.Or(q, a.Le(i, j)), a.False(), p});
    a.And({p, a.False()});
    a.Or({p, a.True()});
    a.And({p, q, a.Not(p)});
    a.Or({p, q, a.Not(p)});
    a.Eq(i, i);
    a.Eq(n(1), n(2));
    a.Eq(a.Member(colour, 0), a.Member(colour, 2));
    for (const TermId t : {a.True(), a.False()}) a.Eq(p, t), a.Eq(t, q);
    a.Eq(y, x), a.Eq(x, y);
    a.Eq(a.MakeRecord(pair, {i, x}), a.MakeRecord(pair, {j, y}));
    a.Eq(i, a.Add(i, n(1)));
    a.Eq(a.Add(i, j), a.Add(j, i));
    a.Ite(a.True(), x, y), a.Ite(a.False(), x, y), a.Ite(p, x, x), a.Ite(a.Not(p), x, y);
    for (const TermId t : {a.True(), a.False()}) a.Ite(p, t, q), a.Ite(p, q, t);
    a.Forall({a.FreshBound("k", a.Int())}, p);
    a.Exists({a.FreshBound("k", a.Real())}, q);
    a.Add({x, f("1.5"), a.Mul(f("2"), x), a.Neg(y), f("-1.5")});
    a.Add({i, a.Neg(i)});
    a.Mul(n(3), n(-4)), a.Mul(f("0"), x), a.Mul(f("1"), x), a.Mul(x, f("2")), a.Mul(y, x);
    a.Mul(f("2"), a.Add(x, f("3"))), a.Mul(f("0.5"), a.Mul(f("4"), y));
    a.Divide(x, f("4"));
    for (const int64_t k : {7, -7}) {
      for (const int64_t d : {2, -2, 3, -3}) a.IntDiv(n(k), n(d)), a.Mod(n(k), n(d));
    }
    a.Le(i, a.Add(i, n(1))), a.Lt(a.Add(x, y), a.Add(y, x)), a.Le(n(2), n(1));
    a.ToReal(n(3));
    for (const char* square : {"4", "2.25", "0"}) a.Apply(Elementary::kSqrt, {f(square)});
    a.Apply(Elementary::kMin, {f("2"), f("-3")}), a.Apply(Elementary::kMax, {f("2"), f("-3")});
    for (const char* one : {"-1.5", "1", "0"}) {
      for (const Elementary e :
           {Elementary::kAbs, Elementary::kSin, Elementary::kCos, Elementary::kTan, Elementary::kAsin,
            Elementary::kAcos, Elementary::kAtan, Elementary::kExp, Elementary::kLog})
        a.Apply(e, {f(one)});
    }
    a.Apply(Elementary::kAtan2, {f("0"), f("2")});
    for (const char* exponent : {"3", "1", "0", "-2"}) a.Apply(Elementary::kPower, {x, f(exponent)});
    a.Apply(Elementary::kPower, {f("-2"), f("3")});
    a.Select(a.Store(v, i, x), j), a.Select(a.Store(v, i, x), i), a.Select(a.Store(v, n(1), x), n(2));
    a.Store(a.Store(v, i, x), i, y);
    a.Field(a.MakeRecord(pair, {i, x}), 1);
    a.Field(a.Ite(p, r, s), 0);
    a.MakeRecord(pair, {a.Field(r, 0), a.Field(r, 1)});
    const TermId list = a.MakeList(a.Int(), {i, j});
    a.Length(list);
    a.At(list, n(1));
  }

  struct Pair {
    Rewrite rewrite;
    TermId plain;
    TermId simple;
  };
  Arena arena_;
  std::vector<Pair> pairs_;
};

TEST_F(Rewrites, PreserveMeaning) {
  Exercise();
  arena_.observer = nullptr;
  const solve::z3::Z3Solver z3;
  for (const Pair& pair : pairs_) {
    std::vector<solve::Assertion> assertions;
    // The lists of the logic are uninterpreted; the two rewrites on them are what the axioms of literals say.
    if (pair.rewrite == Rewrite::kLengthMake || pair.rewrite == Rewrite::kAtMake) continue;
    if (pair.rewrite == Rewrite::kElementaryConstant) continue;  // Z3 does not know them: see below
    const TermId differ = arena_.Raw(Op::kNot, arena_.Bool(), 0,
                                     {arena_.Raw(Op::kEq, arena_.Bool(), 0, {pair.plain, pair.simple})});
    assertions.push_back({differ, ""});
    const solve::Answer answer = z3.Check({&arena_, assertions, {}}, {}, {});
    EXPECT_TRUE(std::holds_alternative<solve::Unsat>(answer)) << Name(pair.rewrite);
  }
}

// The same, by the evaluator, which shares nothing with Z3.
TEST_F(Rewrites, PreserveValues) {
  Exercise();
  arena_.observer = nullptr;
  size_t compared = 0;
  for (int64_t round = 0; round < 8; ++round) {
    const Valuation valuation = [&](TermId leaf) -> std::optional<Value> {
      const int64_t number = (round * 5 + leaf.value * 3) % 7 - 3;
      if (arena_.op(leaf) != Op::kVariable) return std::nullopt;
      if (arena_.sort_of(leaf) == arena_.Bool()) return Value{number > 0};
      if (arena_.sort_of(leaf) == arena_.Int() || arena_.sort_of(leaf) == arena_.Real())
        return Value{Rational(number)};
      return std::nullopt;
    };
    for (const Pair& pair : pairs_) {
      const auto plain = Evaluate(arena_, pair.plain, valuation);
      const auto simple = Evaluate(arena_, pair.simple, valuation);
      if (!plain || !simple) continue;
      ++compared;
      EXPECT_EQ(ToString(*plain), ToString(*simple)) << Name(pair.rewrite);
    }
  }
  EXPECT_GT(compared, 300u);
}

TEST_F(Rewrites, ElementaryConstantsAreWhatTheLibraryComputes) {
  Exercise();
  using Function = double (*)(double);
  const std::map<Elementary, Function> library{{Elementary::kSqrt, std::sqrt}, {Elementary::kAbs, std::fabs},
                                               {Elementary::kSin, std::sin},   {Elementary::kCos, std::cos},
                                               {Elementary::kTan, std::tan},   {Elementary::kAsin, std::asin},
                                               {Elementary::kAcos, std::acos}, {Elementary::kAtan, std::atan},
                                               {Elementary::kExp, std::exp},   {Elementary::kLog, std::log}};
  size_t seen = 0;
  for (const Pair& pair : pairs_) {
    if (pair.rewrite != Rewrite::kElementaryConstant) continue;
    const auto it = library.find(arena_.elementary_of(pair.plain));
    if (it == library.end()) continue;
    ++seen;
    EXPECT_EQ(it->second(arena_.number(arena_.arg(pair.plain, 0)).ToDouble()),
              arena_.number(pair.simple).ToDouble())
        << Name(it->first);
  }
  EXPECT_GE(seen, 14u);
}

TEST_F(Rewrites, AllFire) {
  Exercise();
  std::set<Rewrite> fired;
  for (const Pair& pair : pairs_) fired.insert(pair.rewrite);
  for (size_t r = 0; r < static_cast<size_t>(Rewrite::kCount_); ++r) {
    EXPECT_TRUE(fired.contains(static_cast<Rewrite>(r))) << Name(static_cast<Rewrite>(r));
  }
}

TEST_F(Rewrites, ListLiteralsKnowTheirLengthAndItems) {
  Exercise();
  size_t seen = 0;
  for (const Pair& pair : pairs_) {
    if (pair.rewrite == Rewrite::kLengthMake) {
      ++seen;
      EXPECT_EQ(arena_.number(pair.simple), Rational(2));
    }
    if (pair.rewrite == Rewrite::kAtMake) {
      ++seen;
      EXPECT_EQ(pair.simple, arena_.arg(arena_.arg(pair.plain, 0), 1));
    }
  }
  EXPECT_GE(seen, 2u);
}

}  // namespace
}  // namespace rondo::expr
