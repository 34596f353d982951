#include "choreo/prove/keep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/solve_for.h"
#include "choreo/prove/answer.h"
#include "expr/defined.h"
#include "expr/polynomial.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Numeric;
using expr::Op;
using expr::Rational;
using expr::Substitution;
using expr::TermId;

constexpr int kPieces = 16;  // of a curve through states that are looked for; also the moments that are tried
constexpr size_t kMostSettled = 40;    // conditions without variables
constexpr size_t kMostMonomials = 60;  // of a comparison that is multiplied out

/// One start of a step.
class Keeper {
 public:
  Keeper(Arena& arena, const Keeping& keeping, TermId clock, TermId start,
         const std::function<solve::Answer(TermId, bool)>& ask)
      : arena_(arena), k_(keeping), clock_(clock), start_(start), ask_(ask), during_(keeping.during) {}

  KeepingVerdict Run() {
    Settle();
    Begin();
    Determine();
    // The longest time leaves the most room; only what is determined to take less needs less.
    std::vector<Rational> times{k_.most ? *k_.most : std::max(k_.least, Rational(1))};
    if (k_.most && *k_.most != k_.least && !k_.least.IsZero()) times.push_back(k_.least);
    for (const Rational& time : times) {
      time_ = time;
      for (const bool stay : {true, false}) {
        if (!Ends(stay)) continue;
        if (Keeps(Straight())) return Proved();
        if (stay && std::ranges::all_of(
                        free_, [&](TermId v) { return end_.contains(v) && end_.at(v) == begin_.at(v); }))
          continue;
        if (free_.empty()) break;
      }
    }
    time_ = times.front();
    if (free_.empty()) return Determined();
    if (auto empty = Empty()) return *empty;
    if (auto far = TooFar()) return *far;
    if (Ends(false) || Ends(true)) {
      for (const char* spare : {"2e-2", "5e-3", "2e-3", "1e-4", "0"}) {
        if (const auto curve = Through(*Rational::Parse(spare)); curve && Keeps(*curve)) return Proved();
      }
    }
    if (auto jump = Jump()) return *jump;
    return {Verdict::kUnknown, "no curve was found that keeps it at every moment", {}, {}};
  }

 private:
  TermId Number(const Rational& r) { return arena_.Number(arena_.Real(), r); }
  TermId At(TermId formula, const Rational& seconds) {
    return expr::Substitute(arena_, formula, {{clock_, Number(seconds)}});
  }
  bool Has(TermId formula, TermId variable) const {
    return robot::VariablesOf(arena_, {formula}).contains(variable);
  }
  bool HasFree(TermId term) const {
    return std::ranges::any_of(free_, [&](TermId v) { return Has(term, v); });
  }
  std::vector<TermId> Parts(TermId formula) const {
    const Conjunction parts = Conjuncts(arena_, formula);
    return {parts.begin(), parts.end()};
  }
  std::string NameOf(TermId v) const { return arena_.symbol(arena_.symbol_of(v)).name; }
  TermId Elapsed() {
    return arena_.And(arena_.Le(Number(Rational(0)), clock_), arena_.Le(clock_, Number(time_)));
  }

  bool IsUnsat(TermId formula) {
    solve::Answer answer = ask_(formula, true);
    auto* unsat = std::get_if<solve::Unsat>(&answer);
    if (unsat == nullptr) return false;
    if (!unsat->certificate.empty()) certificates_.push_back(std::move(unsat->certificate));
    return true;
  }
  std::optional<Numeric::Point> Solution(TermId formula) {
    const solve::Answer answer = ask_(formula, false);
    if (std::holds_alternative<solve::Sat>(answer)) return PointOf(answer);
    return std::nullopt;
  }

  KeepingVerdict Proved() { return {Verdict::kProved, {}, {}, std::move(certificates_)}; }

  // Conditions of constants alone, such as whether two points of a path are the same, are decided first.
  void Settle() {
    size_t settled = 0;
    during_ = expr::Transform(arena_, during_, [&](TermId t) {
      const Op op = arena_.op(t);
      if ((op != Op::kEq && op != Op::kLe && op != Op::kLt) || !robot::VariablesOf(arena_, {t}).empty())
        return t;
      if (settled++ >= kMostSettled) return t;
      if (std::holds_alternative<solve::Unsat>(ask_(t, false))) return arena_.False();
      if (std::holds_alternative<solve::Unsat>(ask_(expr::Complement(arena_, t), false)))
        return arena_.True();
      return t;
    });
  }

  // What each state is at the start, if that is said in full.
  void Begin() {
    const std::vector<TermId> parts = Parts(start_);
    for (size_t i = 0; i < k_.moving.size(); ++i) {
      begin_[k_.moving[i]] = k_.before[i];
      for (const TermId part : parts) {
        const auto value = SolveFor(arena_, part, k_.before[i]);
        if (!value || !robot::VariablesOf(arena_, {*value}).empty()) continue;
        begin_[k_.moving[i]] = *value;
        break;
      }
    }
  }

  // `during` may say where a state is, as a function of time and of what others do.
  void Determine() {
    free_ = k_.moving;
    std::vector<TermId> changing = k_.moving;
    for (const TermId v : robot::VariablesOf(arena_, {k_.given, during_, clock_})) changing.push_back(v);
    for (bool grown = true; grown;) {
      grown = false;
      for (const TermId part : Parts(during_)) {
        for (const TermId v : std::vector<TermId>(free_)) {
          auto value = SolveFor(arena_, part, v);
          if (!value) continue;
          value = expr::Substitute(arena_, *value, determined_);
          if (HasFree(*value) || !IsContinuous(arena_, *value, changing)) continue;
          determined_[v] = *value;
          std::erase(free_, v);
          grown = true;
          break;
        }
      }
    }
  }

  // Where each state may end: as `post` says; where it is, if nothing is said; or at a state that does.
  bool Ends(bool stay) {
    end_.clear();
    std::vector<TermId> open = free_;
    if (k_.post != arena_.True()) {
      const TermId post = At(expr::Substitute(arena_, k_.post, determined_), time_);
      for (const TermId part : Parts(post)) {
        for (const TermId v : std::vector<TermId>(open)) {
          const auto value = SolveFor(arena_, part, v);
          if (!value || HasFree(*value)) continue;
          end_[v] = *value;
          std::erase(open, v);
          break;
        }
      }
    }
    for (const TermId v : std::vector<TermId>(open)) {
      if (!stay && (Has(k_.post, v) || Has(during_, v))) continue;
      end_[v] = begin_.at(v);
      std::erase(open, v);
    }
    if (open.empty()) return true;
    const TermId goal = expr::Substitute(arena_, At(arena_.And(k_.post, during_), time_), AtEnd());
    for (const char* spare : {"1e-3", "1e-5", "0"}) {
      const auto point =
          Solution(arena_.And({start_, k_.given, Tightened(arena_, goal, *Rational::Parse(spare))}));
      if (!point) continue;
      for (const TermId v : open) {
        const auto it = point->find(v);
        end_[v] = it == point->end() ? begin_.at(v) : Number(Rational::FromDouble(it->second));
      }
      return true;
    }
    return false;
  }

  Substitution AtEnd() {
    Substitution values = end_;
    for (const auto& [v, value] : determined_) values[v] = At(value, time_);
    return values;
  }

  Curve Straight() {
    CurvePiece piece{Rational(0), time_, determined_};
    const bool instant = time_.IsZero();
    for (const TermId v : free_) {
      const TermId from = begin_.at(v);
      const TermId whole = arena_.Sub(end_.at(v), from);
      piece.value[v] =
          instant ? end_.at(v)
                  : arena_.Add(from, arena_.Mul(arena_.Mul(Number(Rational(1) / time_), clock_), whole));
    }
    Curve curve{piece};
    if (!k_.most) {
      CurvePiece rest{time_, std::nullopt, determined_};
      for (const TermId v : free_) rest.value[v] = end_.at(v);
      curve.push_back(rest);
    }
    return curve;
  }

  // Through states that are allowed at some moments, as near as they are to the straight line.
  std::optional<Curve> Through(const Rational& spare) {
    const auto start = Solution(arena_.And(start_, k_.given));
    if (!start || time_.IsZero()) return std::nullopt;
    Numeric number(arena_, *start);
    std::map<TermId, double> from, to;
    for (const TermId v : free_) {
      from[v] = number(begin_.at(v));
      to[v] = number(end_.at(v));
      if (!std::isfinite(from[v]) || !std::isfinite(to[v])) return std::nullopt;
    }
    std::map<TermId, TermId> last;
    for (const TermId v : free_) last[v] = Number(Rational::FromDouble(from[v]));
    const std::map<TermId, TermId> first = last;
    const TermId allowed = Tightened(arena_, expr::Substitute(arena_, during_, determined_), spare);
    Curve curve;
    double reach = 1e-3;
    for (int n = 1; n <= kPieces; ++n) {
      const Rational begin = time_ * Rational(n - 1) / Rational(kPieces);
      const Rational end = time_ * Rational(n) / Rational(kPieces);
      std::map<TermId, TermId> next;
      if (n == kPieces) {
        for (const TermId v : free_) next[v] = end_.at(v);
      } else if (const auto near = Nearest(At(allowed, end), from, to, double(n) / kPieces, reach)) {
        next = *near;
      } else {
        return std::nullopt;
      }
      CurvePiece piece{begin, end, determined_};
      const TermId share = arena_.Mul(Number(Rational(kPieces) / time_), arena_.Sub(clock_, Number(begin)));
      const TermId left = arena_.Sub(Number(Rational(1)), arena_.Mul(Number(Rational(1) / time_), clock_));
      for (const TermId v : free_) {
        // How far the start is from the one that was tried fades out.
        const TermId beside = arena_.Mul(left, arena_.Sub(begin_.at(v), first.at(v)));
        piece.value[v] =
            arena_.Add({last.at(v), arena_.Mul(share, arena_.Sub(next.at(v), last.at(v))), beside});
      }
      curve.push_back(std::move(piece));
      last = std::move(next);
    }
    if (!k_.most) {
      CurvePiece rest{time_, std::nullopt, determined_};
      for (const TermId v : free_) rest.value[v] = end_.at(v);
      curve.push_back(rest);
    }
    return curve;
  }

  std::optional<std::map<TermId, TermId>> Nearest(TermId allowed, const std::map<TermId, double>& from,
                                                  const std::map<TermId, double>& to, double share,
                                                  double& reach) {
    constexpr double kFarthest = 20, kGrowth = 1.3;
    for (double d = std::max(reach / (kGrowth * kGrowth), 1e-3); d < kFarthest; d *= kGrowth) {
      std::vector<TermId> near{allowed, start_, k_.given};
      for (const TermId v : free_) {
        const double middle = from.at(v) + (to.at(v) - from.at(v)) * share;
        near.push_back(arena_.Le(Number(Rational::FromDouble(middle - d)), v));
        near.push_back(arena_.Le(v, Number(Rational::FromDouble(middle + d))));
      }
      const auto point = Solution(arena_.And(near));
      if (!point) continue;
      reach = d;
      std::map<TermId, TermId> result;
      for (const TermId v : free_) {
        const auto it = point->find(v);
        if (it == point->end()) return std::nullopt;
        result[v] = Number(Rational::FromDouble(it->second));
      }
      return result;
    }
    return std::nullopt;
  }

  // Is `during` true all along the curve, and `post` at its end; does it begin where the step does?
  bool Keeps(const Curve& curve) {
    certificates_.clear();
    const std::vector<TermId> known = Parts(start_);
    std::vector<TermId> fails = BridgeFails(curve.front());
    const auto add = [&](TermId part, TermId given) {
      const bool said = std::ranges::find(known, part) != known.end();
      if (!said) fails.push_back(Fails(part, given));
    };
    for (const CurvePiece& piece : curve) {
      const TermId given = expr::Substitute(arena_, k_.given, piece.value);
      const bool steady = !Has(given, clock_);
      for (const TermId part : Parts(Along(during_, piece.value))) {
        if (!Has(part, clock_)) {
          add(part, steady ? given : arena_.And(given, Within(piece)));
        } else if (piece.to && steady && HoldsBetween(arena_, part, clock_)) {
          for (const Rational& end : {piece.from, *piece.to}) add(At(part, end), given);
        } else {
          add(part, arena_.And(given, Within(piece)));
        }
      }
    }
    fails.push_back(PostFails(curve));
    // One by one: most are plain, and what is left is about few variables.
    return std::ranges::all_of(fails, [&](TermId fail) {
      return fail == arena_.False() || IsUnsat(arena_.And(Related(fail, known), fail));
    });
  }

  // The formula on the curve; comparisons of polynomials multiplied out, since much cancels.
  TermId Along(TermId formula, const Substitution& value) {
    return expr::Transform(arena_, expr::Substitute(arena_, formula, value), [&](TermId t) {
      const Op op = arena_.op(t);
      if ((op != Op::kLe && op != Op::kLt) || arena_.IsPartial(t) || HoldsBetween(arena_, t, clock_))
        return t;
      const auto difference =
          expr::Expand(arena_, arena_.Sub(arena_.arg(t, 0), arena_.arg(t, 1)), kMostMonomials);
      if (!difference) return t;
      const TermId sum = expr::ToTerm(arena_, *difference);
      const TermId zero = Number(Rational(0));
      return op == Op::kLe ? arena_.Le(sum, zero) : arena_.Lt(sum, zero);
    });
  }

  // What is known of the variables of a formula, directly or over others.
  TermId Related(TermId formula, std::vector<TermId> known) {
    std::set<TermId> variables = robot::VariablesOf(arena_, {formula});
    std::vector<TermId> related;
    for (bool grown = true; grown;) {
      grown = false;
      std::erase_if(known, [&](TermId part) {
        const auto own = robot::VariablesOf(arena_, {part});
        if (std::ranges::none_of(own, [&](TermId v) { return variables.contains(v); })) return false;
        related.push_back(part);
        variables.insert(own.begin(), own.end());
        return grown = true;
      });
    }
    return arena_.And(related);
  }

  TermId Fails(TermId part, TermId given) { return arena_.And(given, expr::Complement(arena_, part)); }

  TermId Within(const CurvePiece& piece) {
    const TermId from = arena_.Le(Number(piece.from), clock_);
    return piece.to ? arena_.And(from, arena_.Le(clock_, Number(*piece.to))) : from;
  }

  TermId PostFails(const Curve& curve) {
    if (k_.post == arena_.True() || !k_.most) return arena_.False();
    const Substitution& value = curve.back().value;
    return At(Fails(expr::Substitute(arena_, k_.post, value), expr::Substitute(arena_, k_.given, value)),
              time_);
  }

  // Where the curve begins too far from the start.
  std::vector<TermId> BridgeFails(const CurvePiece& first) {
    std::vector<TermId> fails;
    const TermId given = At(expr::Substitute(arena_, k_.given, first.value), Rational(0));
    for (size_t i = 0; i < k_.moving.size(); ++i) {
      const TermId off = arena_.Sub(At(first.value.at(k_.moving[i]), Rational(0)), begin_.at(k_.moving[i]));
      const TermId most = Number(k_.bridges[i]);
      fails.push_back(arena_.And(given, arena_.Or(arena_.Lt(most, off), arena_.Lt(off, arena_.Neg(most)))));
    }
    return fails;
  }

  // -- what cannot be

  // All is determined, and it fails: when?
  KeepingVerdict Determined() {
    const Curve curve = Straight();
    const CurvePiece& piece = curve.front();
    const TermId given = expr::Substitute(arena_, k_.given, piece.value);
    const TermId during = expr::Substitute(arena_, during_, piece.value);
    Rational until = k_.least;
    if (!k_.most) until = std::max(until, Rational(1));
    const TermId moment =
        arena_.And(arena_.Le(Number(Rational(0)), clock_), arena_.Le(clock_, Number(until)));
    if (const auto at = Solution(arena_.And({start_, given, moment, expr::Complement(arena_, during)})))
      return Refuted("`during` or a range forbids the state in which it says that it is", *at, piece.value);
    if (k_.most && *k_.most == k_.least) {
      if (const auto at = Solution(arena_.And(start_, PostFails(curve))))
        return Refuted("`post` does not hold where `during` says that it ends", *at, piece.value, time_);
    }
    if (const auto at = Solution(arena_.And(start_, arena_.Or(BridgeFails(piece)))))
      return Refuted("it may begin farther than a bridge from where `during` says that it begins", *at,
                     piece.value, Rational(0));
    return {Verdict::kUnknown, "the curve that `during` determines could not be shown to keep it", {}, {}};
  }

  KeepingVerdict Refuted(std::string why, Numeric::Point at, const Substitution& value,
                         std::optional<Rational> moment = {}) {
    if (moment) at[clock_] = moment->ToDouble();
    Numeric number(arena_, at);
    KeepingVerdict kept{Verdict::kRefuted, std::move(why), {}, {}};
    for (const auto& [v, term] : value) kept.values[v] = number(term);
    for (const auto& [v, x] : at) kept.values.emplace(v, x);
    return kept;
  }

  // A moment at which no state is allowed.
  std::optional<KeepingVerdict> Empty() {
    const TermId allowed = expr::Substitute(arena_, during_, determined_);
    const int moments = Has(allowed, clock_) ? kPieces : 0;
    for (int n = 0; n <= moments; ++n) {
      const Rational moment = k_.least * Rational(n) / Rational(kPieces);
      const TermId states = arena_.And(k_.given, At(allowed, moment));
      if (!std::holds_alternative<solve::Unsat>(ask_(states, false))) continue;
      if (!Solution(arena_.And(start_, k_.given))) continue;
      KeepingVerdict kept{Verdict::kRefuted, "no state is allowed at this moment", {}, {}};
      kept.values[clock_] = moment.ToDouble();
      return kept;
    }
    return std::nullopt;
  }

  // No start is within a bridge of a state that is allowed at the beginning.
  std::optional<KeepingVerdict> TooFar() {
    std::vector<TermId> near{start_, k_.given, At(during_, Rational(0))};
    for (size_t i = 0; i < k_.moving.size(); ++i) {
      const TermId off = arena_.Sub(k_.moving[i], k_.before[i]);
      near.push_back(arena_.Le(off, Number(k_.bridges[i])));
      near.push_back(arena_.Le(arena_.Neg(off), Number(k_.bridges[i])));
    }
    if (!std::holds_alternative<solve::Unsat>(ask_(arena_.And(near), false))) return std::nullopt;
    const auto start = Solution(arena_.And(start_, k_.given));
    if (!start) return std::nullopt;
    return Refuted("it begins farther than a bridge from where `during` allows it to begin", *start, begin_,
                   Rational(0));
  }

  // A value of a state that is not allowed at any moment, between where it begins and where it ends.
  std::optional<KeepingVerdict> Jump() {
    if (k_.most && *k_.most != k_.least && !k_.least.IsZero()) time_ = *k_.most;
    const auto start = Solution(arena_.And(start_, k_.given));
    if (!start || end_.empty()) return std::nullopt;
    Numeric number(arena_, *start);
    for (const TermId v : free_) {
      const double from = number(begin_.at(v)), to = number(end_.at(v));
      if (!std::isfinite(from) || !std::isfinite(to) || !(std::abs(to - from) > 1e-6)) continue;
      for (int n = 1; n < kPieces; ++n) {
        const Rational middle = Rational::FromDouble(from + (to - from) * n / kPieces);
        if (!IsBarrier(v, middle, from < to)) continue;
        KeepingVerdict kept{
            Verdict::kRefuted, fmt::format("`{}` would have to jump over a value", NameOf(v)), {}, {}};
        kept.values[v] = middle.ToDouble();
        return kept;
      }
    }
    return std::nullopt;
  }

  bool IsBarrier(TermId v, const Rational& middle, bool upwards) {
    const TermId at = Number(middle);
    const auto impossible = [&](TermId f) { return std::holds_alternative<solve::Unsat>(ask_(f, false)); };
    // A start may be bridged, so that it has to be that much away.
    const auto which = static_cast<size_t>(std::ranges::find(k_.moving, v) - k_.moving.begin());
    const TermId bridge = Number(upwards ? k_.bridges[which] : Rational(0) - k_.bridges[which]);
    const auto wrong_side = [&](TermId t, bool low) { return low ? arena_.Le(at, t) : arena_.Le(t, at); };
    const TermId most = k_.most ? Elapsed() : arena_.Le(Number(Rational(0)), clock_);
    if (!impossible(arena_.And({k_.given, during_, most, arena_.Eq(v, at)}))) return false;
    if (!impossible(arena_.And(start_, wrong_side(arena_.Add(begin_.at(v), bridge), upwards)))) return false;
    return impossible(arena_.And({k_.given, during_, k_.post, most, wrong_side(v, !upwards)}));
  }

  Arena& arena_;
  const Keeping& k_;
  TermId clock_;
  TermId start_;
  const std::function<solve::Answer(TermId, bool)>& ask_;
  TermId during_;
  Rational time_;             // that the curve takes
  std::vector<TermId> free_;  // states that no equation determines
  Substitution begin_, end_, determined_;
  std::vector<std::string> certificates_;
};

}  // namespace

KeepingVerdict Keep(Arena& arena, const Keeping& keeping, TermId clock,
                    const std::function<solve::Answer(TermId, bool)>& ask) {
  KeepingVerdict all{Verdict::kProved, {}, {}, {}};
  for (const TermId start : keeping.starts) {
    KeepingVerdict one = Keeper(arena, keeping, clock, start, ask).Run();
    if (one.verdict != Verdict::kProved) return one;
    std::ranges::move(one.certificates, std::back_inserter(all.certificates));
  }
  return all;
}

}  // namespace rondo::choreo
