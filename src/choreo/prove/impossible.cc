#include "choreo/prove/impossible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "choreo/prove/curve_proof.h"
#include "expr/defined.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using expr::Numeric;
using expr::Rational;
using expr::Substitution;
using expr::TermId;

KeepingVerdict Refuted(KeepingStart& s, std::string why, Numeric::Point at, const Substitution& value,
                       std::optional<Rational> moment = {}) {
  if (moment) at[s.clock()] = moment->ToDouble();
  Numeric number(s.arena(), at);
  KeepingVerdict verdict{verdict::Verdict::kRefuted, std::move(why), {}, {}};
  for (const auto& [v, term] : value) verdict.values[v] = number(term);
  for (const auto& [v, x] : at) verdict.values.emplace(v, x);
  return verdict;
}

// Is the value not allowed at any moment, and does the state have to get from one side of it to the other?
bool IsBarrier(KeepingStart& s, TermId v, const Rational& middle, bool upwards) {
  expr::Arena& arena = s.arena();
  const Keeping& k = s.keeping();
  const TermId at = s.Number(middle);
  // A start may be bridged, so that it has to be that much away.
  const auto which = static_cast<size_t>(std::ranges::find(k.moving, v) - k.moving.begin());
  const TermId bridge = s.Number(upwards ? k.bridges[which] : Rational(0) - k.bridges[which]);
  const auto beyond = [&](TermId t, bool above) { return above ? arena.Le(at, t) : arena.Le(t, at); };
  const TermId any = s.Elapsed(k.most);
  return s.IsImpossible(arena.And({k.given, s.during(), any, arena.Eq(v, at)})) &&
         s.IsImpossible(arena.And(s.start(), beyond(arena.Add(s.Begin(v), bridge), upwards))) &&
         s.IsImpossible(arena.And({k.given, s.during(), k.post, any, beyond(v, !upwards)}));
}

}  // namespace

std::optional<KeepingVerdict> DeterminedFails(KeepingStart& s, const Curve& whole,
                                              const Substitution& determined) {
  expr::Arena& arena = s.arena();
  const Keeping& k = s.keeping();
  const Curve curve = s.switches().Split(whole);
  for (size_t i = 1; i < curve.size() && curve[i].from <= k.least; ++i) {
    if (const auto at = s.Solution(arena.And(s.start(), Jumps(s, curve[i - 1], curve[i]))))
      return Refuted(s, "it would have to jump at this moment", *at, curve[i - 1].value, curve[i].from);
  }
  const TermId given = expr::Substitute(arena, k.given, determined);
  const TermId during = expr::Substitute(arena, s.during(), determined);
  const Rational until = k.most || k.ends ? k.least : std::max(k.least, Rational(1));
  if (const auto at =
          s.Solution(arena.And({s.start(), given, s.Elapsed(until), expr::Complement(arena, during)})))
    return Refuted(s, "`during` or a range forbids the state in which it says that it is", *at, determined);
  if (k.most && *k.most == k.least) {
    if (const auto at = s.Solution(arena.And(s.start(), PostFails(s, curve))))
      return Refuted(s, "`post` does not hold where `during` says that it ends", *at, curve.back().value,
                     *k.most);
  }
  if (const auto at = s.Solution(arena.And(s.start(), arena.Or(BridgeFails(s, curve.front())))))
    return Refuted(s, "it may begin farther than a bridge from where `during` says that it begins", *at,
                   s.begin(), Rational(0));
  return std::nullopt;
}

std::optional<KeepingVerdict> NoState(KeepingStart& s, const Substitution& determined, int moments) {
  const Keeping& k = s.keeping();
  const TermId allowed = expr::Substitute(s.arena(), s.during(), determined);
  if (!s.Has(allowed, s.clock())) moments = 0;
  for (int n = 0; n <= moments; ++n) {
    const Rational moment = moments == 0 ? Rational(0) : k.least * Rational(n) / Rational(moments);
    if (!s.IsImpossible(s.arena().And(k.given, s.At(allowed, moment)))) continue;
    if (!s.Solution(s.arena().And(s.start(), k.given))) continue;
    return Refuted(s, "no state is allowed at this moment", {}, {}, moment);
  }
  return std::nullopt;
}

std::optional<KeepingVerdict> TooFar(KeepingStart& s) {
  expr::Arena& arena = s.arena();
  const Keeping& k = s.keeping();
  std::vector<TermId> near{s.start(), s.AtStart(arena.And(k.given, s.during()))};
  for (size_t i = 0; i < k.moving.size(); ++i) {
    const TermId off = arena.Sub(k.moving[i], k.before[i]);
    near.push_back(arena.Le(off, s.Number(k.bridges[i])));
    near.push_back(arena.Le(arena.Neg(off), s.Number(k.bridges[i])));
  }
  if (!s.IsImpossible(arena.And(near))) return std::nullopt;
  const auto start = s.Solution(arena.And(s.start(), k.given));
  if (!start) return std::nullopt;
  return Refuted(s, "it begins farther than a bridge from where `during` allows it to begin", *start,
                 s.begin(), Rational(0));
}

std::optional<KeepingVerdict> NeedsJump(KeepingStart& s, const std::vector<TermId>& free,
                                        const Substitution& ends, int values) {
  const auto start = s.Solution(s.arena().And(s.start(), s.keeping().given));
  if (!start) return std::nullopt;
  Numeric number(s.arena(), *start);
  for (const TermId v : free) {
    const auto end = ends.find(v);
    if (end == ends.end()) continue;
    const double from = number(s.Begin(v)), to = number(end->second);
    if (!std::isfinite(from) || !std::isfinite(to) || !(std::abs(to - from) > 1e-6)) continue;
    for (int n = 1; n < values; ++n) {
      const Rational middle = Rational::FromDouble(from + (to - from) * n / values);
      if (!IsBarrier(s, v, middle, from < to)) continue;
      const std::string& name = s.arena().symbol(s.arena().symbol_of(v)).name;
      KeepingVerdict verdict{
          verdict::Verdict::kRefuted, fmt::format("`{}` would have to jump over a value", name), {}, {}};
      verdict.values[v] = middle.ToDouble();
      return verdict;
    }
  }
  return std::nullopt;
}

}  // namespace rondo::choreo
