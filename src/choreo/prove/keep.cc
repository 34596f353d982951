#include "choreo/prove/keep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "choreo/obligations/solve_for.h"
#include "choreo/prove/curve_proof.h"
#include "choreo/prove/impossible.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Numeric;
using expr::Rational;
using expr::Substitution;
using expr::TermId;

constexpr int kPieces = 16;  // of a curve through states that are looked for; also the moments that are tried
// How much room inequalities should leave along such a curve, in their own units: much is better, if there is
// room.
constexpr std::array<const char*, 5> kSpares{"2e-2", "5e-3", "2e-3", "1e-4", "0"};

/// Looks for curves from one start.
class Keeper {
 public:
  explicit Keeper(KeepingStart& start)
      : s_(start), arena_(start.arena()), k_(start.keeping()), free_(k_.moving) {}

  KeepingVerdict Run() {
    Determine();
    // The longest time leaves the most room; only what is determined to take less needs less.
    std::vector<Rational> times{k_.most ? *k_.most : std::max(k_.least, Rational(1))};
    if (k_.chooses && k_.most && *k_.most != k_.least && !k_.least.IsZero()) times.push_back(k_.least);
    if (!k_.most && k_.ends && !k_.chooses)
      return {verdict::Verdict::kUnknown,
              "nothing says how long it may take, and others have to keep on meanwhile",
              {},
              {}};
    for (const Rational& time : times) {
      time_ = time;
      // States that nothing forces to move had better stay.
      std::optional<Substitution> tried;
      for (const bool stay : {true, false}) {
        if (!Ends(stay) || tried == end_) continue;
        if (Keeps(s_, Straight())) return Proved();
        tried = end_;
      }
    }
    time_ = times.front();
    if (free_.empty()) {
      if (auto fails = DeterminedFails(s_, Straight(), determined_)) return *fails;
      return {verdict::Verdict::kUnknown,
              "the curve that `during` determines could not be shown to keep it",
              {},
              {}};
    }
    if (auto none = NoState(s_, determined_, kPieces)) return *none;
    if (auto far = TooFar(s_)) return *far;
    if (Ends(false) || Ends(true)) {
      for (const char* spare : kSpares) {
        if (const auto curve = Through(*Rational::Parse(spare)); curve && Keeps(s_, *curve)) return Proved();
      }
    }
    if (auto jump = NeedsJump(s_, free_, end_, kPieces)) return *jump;
    return {verdict::Verdict::kUnknown, "no curve was found that keeps it at every moment", {}, {}};
  }

 private:
  KeepingVerdict Proved() { return {verdict::Verdict::kProved, {}, {}, s_.TakeCertificates()}; }
  TermId Number(const Rational& r) { return s_.Number(r); }
  bool HasFree(TermId term) const {
    return std::ranges::any_of(free_, [&](TermId v) { return s_.Has(term, v); });
  }

  // `during` may say where a state is, as a function of time and of what others do.
  void Determine() {
    changing_ = k_.moving;
    for (const TermId v : robot::VariablesOf(arena_, {k_.given, s_.during(), k_.post, s_.clock()}))
      changing_.push_back(v);
    for (bool grown = true; grown;) {
      grown = false;
      for (const TermId part : s_.Parts(s_.during())) {
        for (const TermId v : std::vector<TermId>(free_)) {
          auto value = SolveFor(arena_, part, v);
          if (!value) continue;
          value = expr::Substitute(arena_, *value, determined_);
          if (HasFree(*value) || !s_.switches().IsContinuousBetween(*value, changing_)) continue;
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
      const TermId post = s_.At(expr::Substitute(arena_, k_.post, determined_), time_);
      for (const TermId part : s_.Parts(post)) {
        for (const TermId v : std::vector<TermId>(open)) {
          const auto value = SolveFor(arena_, part, v);
          if (!value || HasFree(*value) || !IsContinuous(arena_, *value, changing_)) continue;
          end_[v] = *value;
          std::erase(open, v);
          break;
        }
      }
    }
    for (const TermId v : std::vector<TermId>(open)) {
      if (!stay && (s_.Has(k_.post, v) || s_.Has(s_.during(), v))) continue;
      end_[v] = s_.Begin(v);
      std::erase(open, v);
    }
    if (open.empty()) return true;
    const TermId goal = expr::Substitute(arena_, s_.At(arena_.And(k_.post, s_.during()), time_), AtEnd());
    for (const char* spare : {"1e-3", "1e-5", "0"}) {
      const auto point =
          s_.Solution(arena_.And({s_.start(), k_.given, Tightened(arena_, goal, *Rational::Parse(spare))}));
      if (!point) continue;
      for (const TermId v : open) {
        const auto it = point->find(v);
        end_[v] = it == point->end() ? s_.Begin(v) : Number(Rational::FromDouble(it->second));
      }
      return true;
    }
    return false;
  }

  Substitution AtEnd() {
    Substitution values = end_;
    for (const auto& [v, value] : determined_) values[v] = s_.At(value, time_);
    return values;
  }

  Curve Straight() {
    CurvePiece piece{Rational(0), time_, determined_};
    const bool instant = time_.IsZero();
    for (const TermId v : free_) {
      const TermId from = s_.Begin(v);
      const TermId whole = arena_.Sub(end_.at(v), from);
      piece.value[v] =
          instant ? end_.at(v)
                  : arena_.Add(from, arena_.Mul(arena_.Mul(Number(Rational(1) / time_), s_.clock()), whole));
    }
    Curve curve{piece};
    if (!k_.most && !k_.ends) {
      CurvePiece rest{time_, std::nullopt, determined_};
      for (const TermId v : free_) rest.value[v] = end_.at(v);
      curve.push_back(rest);
    }
    return curve;
  }

  // Through states that are allowed at some moments, as near as they are to the straight line.
  std::optional<Curve> Through(const Rational& spare) {
    const auto start = s_.Solution(arena_.And(s_.start(), k_.given));
    if (!start || time_.IsZero()) return std::nullopt;
    Numeric number(arena_, *start);
    std::map<TermId, double> from, to;
    for (const TermId v : free_) {
      from[v] = number(s_.Begin(v));
      to[v] = number(end_.at(v));
      if (!std::isfinite(from[v]) || !std::isfinite(to[v])) return std::nullopt;
    }
    std::map<TermId, TermId> last;
    for (const TermId v : free_) last[v] = Number(Rational::FromDouble(from[v]));
    const std::map<TermId, TermId> first = last;
    const TermId allowed = Tightened(arena_, expr::Substitute(arena_, s_.during(), determined_), spare);
    Curve curve;
    double reach = 1e-3;
    for (int n = 1; n <= kPieces; ++n) {
      const Rational begin = time_ * Rational(n - 1) / Rational(kPieces);
      const Rational end = time_ * Rational(n) / Rational(kPieces);
      std::map<TermId, TermId> next;
      if (n == kPieces) {
        for (const TermId v : free_) next[v] = end_.at(v);
      } else if (const auto near = Nearest(s_.At(allowed, end), from, to, double(n) / kPieces, reach)) {
        next = *near;
      } else {
        return std::nullopt;
      }
      CurvePiece piece{begin, end, determined_};
      const TermId share =
          arena_.Mul(Number(Rational(kPieces) / time_), arena_.Sub(s_.clock(), Number(begin)));
      const TermId left =
          arena_.Sub(Number(Rational(1)), arena_.Mul(Number(Rational(1) / time_), s_.clock()));
      for (const TermId v : free_) {
        // How far the start is from the one that was tried fades out.
        const TermId beside = arena_.Mul(left, arena_.Sub(s_.Begin(v), first.at(v)));
        piece.value[v] =
            arena_.Add({last.at(v), arena_.Mul(share, arena_.Sub(next.at(v), last.at(v))), beside});
      }
      curve.push_back(std::move(piece));
      last = std::move(next);
    }
    if (!k_.most && !k_.ends) {
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
    double d = std::max(reach / (kGrowth * kGrowth), 1e-3);
    while (d < kFarthest) {
      std::vector<TermId> near{allowed, s_.start(), k_.given};
      for (const TermId v : free_) {
        const double middle = from.at(v) + (to.at(v) - from.at(v)) * share;
        near.push_back(arena_.Le(Number(Rational::FromDouble(middle - d)), v));
        near.push_back(arena_.Le(v, Number(Rational::FromDouble(middle + d))));
      }
      const auto point = s_.Solution(arena_.And(near));
      if (!point) {
        d *= kGrowth;
        continue;
      }
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

  KeepingStart& s_;
  Arena& arena_;
  const Keeping& k_;
  std::vector<TermId> changing_;   // all that may change meanwhile
  std::vector<TermId> free_;       // states that no equation determines
  Substitution determined_, end_;  // the others, over the clock; where free ones may end
  Rational time_;                  // that the curve takes
};

}  // namespace

KeepingVerdict Keep(Arena& arena, const Keeping& keeping, TermId clock, const AskSolver& ask) {
  KeepingVerdict all{verdict::Verdict::kProved, {}, {}, {}};
  for (const TermId formula : keeping.starts) {
    KeepingStart start(arena, keeping, clock, formula, ask);
    KeepingVerdict one = Keeper(start).Run();
    if (one.verdict != verdict::Verdict::kProved) return one;
    std::ranges::move(one.certificates, std::back_inserter(all.certificates));
  }
  return all;
}

}  // namespace rondo::choreo
