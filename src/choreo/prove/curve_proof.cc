#include "choreo/prove/curve_proof.h"

#include <algorithm>
#include <map>
#include <set>

#include "choreo/obligations/facts.h"
#include "expr/defined.h"
#include "expr/polynomial.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Op;
using expr::Rational;
using expr::Substitution;
using expr::TermId;

// The formula on the curve; comparisons of polynomials are multiplied out, since much cancels.
TermId Along(KeepingStart& s, TermId formula, const Substitution& value) {
  constexpr size_t kMostMonomials = 60;
  Arena& arena = s.arena();
  return expr::Transform(arena, expr::Substitute(arena, formula, value), [&](TermId t) {
    const Op op = arena.op(t);
    const bool compares = op == Op::kLe || op == Op::kLt;
    if (!compares || arena.IsPartial(t) || HoldsBetween(arena, t, s.clock())) return t;
    const auto difference = expr::Expand(arena, arena.Sub(arena.arg(t, 0), arena.arg(t, 1)), kMostMonomials);
    if (!difference) return t;
    const TermId sum = expr::ToTerm(arena, *difference), zero = s.Number(Rational(0));
    return op == Op::kLe ? arena.Le(sum, zero) : arena.Lt(sum, zero);
  });
}

// What is known of the variables of a formula, directly or over others.
TermId Related(KeepingStart& s, TermId formula, std::vector<TermId> known) {
  std::set<TermId> variables = robot::VariablesOf(s.arena(), {formula});
  std::map<TermId, std::set<TermId>> own;
  for (const TermId part : known) own.emplace(part, robot::VariablesOf(s.arena(), {part}));
  return s.arena().And(
      TakeConnected(variables, known, [&](TermId part) -> const std::set<TermId>& { return own.at(part); }));
}

TermId Fails(KeepingStart& s, TermId part, TermId given) {
  return s.arena().And(given, expr::Complement(s.arena(), part));
}

TermId Within(KeepingStart& s, const CurvePiece& piece) {
  Arena& arena = s.arena();
  const TermId from = arena.Le(s.Number(piece.from), s.clock());
  return piece.to ? arena.And(from, arena.Le(s.clock(), s.Number(*piece.to))) : from;
}

// Where `during` fails in one piece of the curve.
void DuringFails(KeepingStart& s, const CurvePiece& piece, const std::vector<TermId>& known,
                 std::vector<TermId>& fails) {
  const TermId given = expr::Substitute(s.arena(), s.keeping().given, piece.value);
  const bool steady = !s.Has(given, s.clock());
  const auto add = [&](TermId part, TermId when) {
    const bool said = std::ranges::find(known, part) != known.end();
    if (!said) fails.push_back(Fails(s, part, when));
  };
  // At its ends by the choices of that very moment, which may be others than before and behind it.
  for (const std::optional<Rational>& end : {std::optional(piece.from), piece.to}) {
    if (!end || !s.switches().any()) continue;
    const TermId then = s.At(expr::Substitute(s.arena(), s.during(), piece.value), *end);
    fails.push_back(Fails(s, then, s.At(given, *end)));
  }
  const TermId during = s.switches().Settled(s.during(), piece.from, piece.to);
  for (const TermId part : s.Parts(Along(s, during, piece.value))) {
    if (!s.Has(part, s.clock()) && steady) {
      add(part, given);
    } else if (piece.to && steady && HoldsBetween(s.arena(), part, s.clock())) {
      add(s.At(part, piece.from), given);
      add(s.At(part, *piece.to), given);
    } else {
      add(part, s.arena().And(given, Within(s, piece)));
    }
  }
}

}  // namespace

bool Keeps(KeepingStart& s, const Curve& whole) {
  s.Forget();
  const Curve curve = s.switches().Split(whole);
  std::vector<TermId> fails = BridgeFails(s, curve.front());
  for (size_t i = 1; i < curve.size(); ++i) fails.push_back(Jumps(s, curve[i - 1], curve[i]));
  const std::vector<TermId> known = s.Parts(s.start());
  for (const CurvePiece& piece : curve) DuringFails(s, piece, known, fails);
  fails.push_back(PostFails(s, curve));
  // One by one: most are plain, and what is left is about few variables.
  return std::ranges::all_of(fails, [&](TermId fail) {
    return fail == s.arena().False() || s.Refutes(s.arena().And(Related(s, fail, known), fail));
  });
}

std::vector<TermId> BridgeFails(KeepingStart& s, const CurvePiece& first) {
  Arena& arena = s.arena();
  const Keeping& k = s.keeping();
  std::vector<TermId> fails;
  const TermId given = s.AtStart(expr::Substitute(arena, k.given, first.value));
  for (size_t i = 0; i < k.moving.size(); ++i) {
    const TermId off = arena.Sub(s.AtStart(first.value.at(k.moving[i])), s.Begin(k.moving[i]));
    const TermId most = s.Number(k.bridges[i]);
    fails.push_back(arena.And(given, arena.Or(arena.Lt(most, off), arena.Lt(off, arena.Neg(most)))));
  }
  return fails;
}

TermId Jumps(KeepingStart& s, const CurvePiece& left, const CurvePiece& right) {
  Arena& arena = s.arena();
  std::vector<TermId> differ;
  for (const auto& [v, value] : left.value) {
    const TermId a = s.At(value, right.from), b = s.At(right.value.at(v), right.from);
    if (a != b) differ.push_back(arena.Or(arena.Lt(a, b), arena.Lt(b, a)));
  }
  return arena.And(s.At(expr::Substitute(arena, s.keeping().given, left.value), right.from),
                   arena.Or(differ));
}

TermId PostFails(KeepingStart& s, const Curve& curve) {
  const Keeping& k = s.keeping();
  const CurvePiece& last = curve.back();
  if (k.post == s.arena().True() || !last.to) return s.arena().False();
  const TermId post = expr::Substitute(s.arena(), k.post, last.value);
  return s.At(Fails(s, post, expr::Substitute(s.arena(), k.given, last.value)), *last.to);
}

}  // namespace rondo::choreo
