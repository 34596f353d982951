#include "choreo/prove/decide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "choreo/prove/answer.h"
#include "choreo/prove/exact_point.h"
#include "choreo/prove/keep.h"
#include "expr/defined.h"
#include "expr/import.h"
#include "robot/separation/cuts.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Numeric;
using expr::TermId;
using robot::Meeting;
using robot::Shape;

constexpr size_t kMostPieces = 400;
constexpr size_t kMostRounds = 60;
constexpr double kFinest = 1e-7;

/// Copies shapes to another arena.
class Copy {
 public:
  Copy(const Arena& from, Arena& to) : import_(from, to) {}

  TermId operator()(TermId t) { return t.valid() ? import_(t) : t; }
  robot::Vector operator()(const robot::Vector& v) { return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])}; }
  Shape operator()(const Shape& shape) {
    Shape s = shape;
    if (!shape.parts.empty()) {
      for (Shape& p : s.parts) p = (*this)(p);
    }
    for (robot::Vector& row : s.frame.rotation) row = (*this)(row);
    s.frame.origin = (*this)(s.frame.origin);
    for (TermId& t : s.sizes) t = (*this)(t);
    for (robot::Face& f : s.faces) f = {(*this)(f.normal), (*this)(f.offset), (*this)(f.length)};
    return s;
  }
  Meeting operator()(const Meeting& meeting) {
    Meeting m{(*this)(meeting.configuration), {}, (*this)(meeting.where), {}};
    for (const Shape& s : meeting.shapes) m.shapes.push_back((*this)(s));
    if (meeting.beyond) m.beyond = (*this)(*meeting.beyond);
    return m;
  }

 private:
  expr::Importer import_;
};

class Deciding {
 public:
  Deciding(const Obligation& obligation, const robot::World& world, const Arena& from,
           const solve::icp::Options& engine, const Limits& limits, const base::StopToken& stop)
      : obligation_(obligation),
        world_(world),
        copy_(from, arena_),
        engine_(engine),
        limits_(limits),
        deadline_(base::StopToken::Clock::now() + limits.time),
        stop_(stop.WithDeadline(deadline_)) {
    point_ = copy_(world.point);
    if (obligation.meeting) meeting_ = copy_(*obligation.meeting);
  }

  Decision Run() {
    if (obligation_.keeping) {
      Keeps(*obligation_.keeping);
      return std::move(decision_);
    }
    if (obligation_.satisfiable) {
      HasSolution();
    } else if (!meeting_) {
      HasNone({copy_(obligation_.formula)});
    } else if (!Sizes() && !(limits_.separation && Separated())) {
      Points();
    }
    if (decision_.verdict == verdict::Verdict::kRefuted && !obligation_.satisfiable) Reachable();
    return std::move(decision_);
  }

 private:
  solve::Answer Ask(TermId formula, bool certificate, double precision = 0) {
    ++decision_.questions;
    solve::Query query;
    query.arena = &arena_;
    query.assertions = {{formula, ""}};
    solve::Budget budget;
    budget.time = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::max(deadline_ - base::StopToken::Clock::now(), base::StopToken::Clock::duration::zero()));
    budget.core = false;
    budget.certificate = certificate && limits_.certificates;
    solve::icp::Options engine = engine_;
    engine.precision = std::max(engine.precision, precision);
    return solve::icp::IcpSolver(engine).Check(query, budget, stop_);
  }

  // Refuted: remembers the certificate.
  bool IsUnsat(solve::Answer& answer) {
    auto* unsat = std::get_if<solve::Unsat>(&answer);
    if (unsat == nullptr) return false;
    if (limits_.certificates) decision_.certificates.push_back(std::move(unsat->certificate));
    return true;
  }

  void Proved(Way way) {
    decision_.verdict = verdict::Verdict::kProved;
    decision_.way = way;
  }

  // All variables of the world, the point last: only a witness needs them.
  void NameVariables() {
    if (!names_.empty()) return;
    for (const robot::Body& b : world_.bodies) {
      for (const auto& v : b.states) names_.emplace_back(v.term, copy_(v.term));
      for (const auto& v : b.inputs) names_.emplace_back(v.term, copy_(v.term));
    }
    for (const auto& v : world_.environment) names_.emplace_back(v.term, copy_(v.term));
    names_.emplace_back(world_.clock, copy_(world_.clock));
    for (size_t i = 0; i < 3; ++i) names_.emplace_back(world_.point[i], point_[i]);
  }

  void SetWitness(const solve::Answer& answer) {
    const auto* sat = std::get_if<solve::Sat>(&answer);
    SetWitness(PointOf(answer), sat != nullptr && sat->exact);
  }

  void SetWitness(const Numeric::Point& found, bool exact) {
    NameVariables();
    decision_.witness.values.clear();
    for (const auto& [original, own] : names_) {
      const auto it = found.find(own);
      if (it != found.end()) decision_.witness.values.emplace(original, it->second);
    }
    decision_.witness.exact = exact;
  }

  void Undecided(const solve::Answer& answer) {
    decision_.verdict = verdict::Verdict::kUnknown;
    decision_.certificates.clear();
    if (const auto* unknown = std::get_if<solve::Unknown>(&answer)) {
      decision_.reason = unknown->reason;
    } else {
      decision_.reason = "not separated by more than the precision of the search";
      SetWitness(answer);
    }
  }

  // A witness is one only if the rest that is known has a solution as well.
  void Reachable() {
    solve::Answer answer = Ask(copy_(obligation_.rest), true);
    if (std::holds_alternative<solve::Sat>(answer)) return;
    decision_.certificates.clear();
    if (IsUnsat(answer)) return Proved(Way::kPoints);
    decision_.verdict = verdict::Verdict::kUnknown;
    decision_.reason = "it fails, unless what is known of the other robots is contradictory";
  }

  void Keeps(Keeping keeping) {
    const auto copy_all = [&](std::vector<TermId>& terms) {
      for (TermId& t : terms) t = copy_(t);
    };
    copy_all(keeping.moving);
    copy_all(keeping.before);
    copy_all(keeping.others);
    copy_all(keeping.others_before);
    copy_all(keeping.starts);
    for (TermId* t : {&keeping.given, &keeping.during, &keeping.post}) *t = copy_(*t);
    KeepingVerdict kept = Keep(arena_, keeping, copy_(world_.clock),
                               [&](TermId formula, bool certificate) { return Ask(formula, certificate); });
    decision_.verdict = kept.verdict;
    decision_.way = Way::kCurve;
    decision_.reason = std::move(kept.why);
    if (stop_.StopRequested() && kept.verdict == verdict::Verdict::kUnknown) decision_.reason = "out of time";
    decision_.certificates = std::move(kept.certificates);
    SetWitness(kept.values, true);
  }

  void HasSolution() {
    const TermId formula = copy_(obligation_.formula);
    solve::Answer answer = Ask(formula, true);
    if (std::holds_alternative<solve::Sat>(answer)) {
      Proved(Way::kPoints);
      SetWitness(answer);
    } else if (IsUnsat(answer)) {
      decision_.verdict = verdict::Verdict::kRefuted;
    } else {
      Undecided(answer);
    }
  }

  // None of the formulas has a solution.
  void HasNone(const std::vector<TermId>& formulas) {
    for (const TermId f : formulas) {
      solve::Answer answer = Ask(f, true);
      if (IsUnsat(answer)) continue;
      if (std::holds_alternative<solve::Sat>(answer)) {
        decision_.verdict = verdict::Verdict::kRefuted;
        SetWitness(answer);
      } else if (const auto exact = std::holds_alternative<solve::DeltaSat>(answer)
                                        ? ExactPoint(arena_, f, PointOf(answer))
                                        : std::nullopt) {
        decision_.verdict = verdict::Verdict::kRefuted;
        SetWitness(*exact, true);
      } else {
        Undecided(answer);
      }
      return;
    }
    Proved(Way::kPoints);
  }

  bool Sizes() {
    if (!meeting_->beyond || meeting_->shapes.size() != 1) return false;
    const TermId within = robot::Within(arena_, meeting_->shapes[0], *meeting_->beyond);
    const TermId formula = arena_.And(meeting_->configuration, expr::Complement(arena_, within));
    solve::Answer answer = Ask(formula, true);
    if (!IsUnsat(answer)) return false;
    Proved(Way::kSizes);
    return true;
  }

  // Each piece by separating directions, one more for each configuration at which nothing separates yet.
  bool Separated() {
    const auto pieces = robot::PiecesOf(arena_, point_, *meeting_, kMostPieces);
    if (!pieces) return false;
    for (const robot::Piece& piece : *pieces) {
      if (!Separated(piece)) {
        decision_.certificates.clear();
        return false;
      }
    }
    Proved(Way::kSeparation);
    return true;
  }

  bool Separated(const robot::Piece& piece) {
    robot::Cuts cuts(arena_, piece);
    std::vector<TermId> conditions = cuts.Common();
    conditions.push_back(meeting_->configuration);
    std::vector<TermId> spare;
    double precision = 1e-2;
    for (size_t round = 0; round < kMostRounds && !stop_.StopRequested(); ++round) {
      solve::Answer answer = Ask(arena_.And(conditions), true, precision);
      if (IsUnsat(answer)) return true;
      if (std::holds_alternative<solve::Unknown>(answer)) return false;
      const robot::Cut cut = cuts.At(PointOf(answer));
      decision_.apart = cut.apart;
      if (cut.conditions.empty()) {
        // They seem to meet; perhaps where the configuration is none.
        if (std::holds_alternative<solve::DeltaSat>(answer) && precision > kFinest) {
          precision = std::max(precision / 100, kFinest);
          continue;
        }
        meets_ = std::move(answer);
        return false;
      }
      // The first one may do; the others, should it not.
      conditions.insert(conditions.end(), spare.begin(), spare.end());
      conditions.push_back(cut.conditions.front());
      spare.assign(cut.conditions.begin() + 1, cut.conditions.end());
    }
    return false;
  }

  // |variable - value| <= slack
  void Near(TermId variable, double value, double slack, std::vector<TermId>& formulas) {
    if (!std::isfinite(value)) return;
    const TermId at = arena_.Number(arena_.Real(), expr::Rational::FromDouble(value));
    const TermId by = arena_.Number(arena_.Real(), expr::Rational::FromDouble(slack));
    formulas.push_back(arena_.Le(arena_.Sub(variable, at), by));
    formulas.push_back(arena_.Le(arena_.Sub(at, variable), by));
  }

  void Points() {
    const TermId whole = robot::Formula(arena_, point_, *meeting_);
    // Where the shapes seem to meet, if that is known: then only the point is missing.
    if (meets_) {
      for (const double slack : {0.0, 1e-6, 1e-3}) {
        std::vector<TermId> near{whole};
        for (const auto& [variable, value] : PointOf(*meets_)) {
          Near(variable, value, slack, near);
        }
        if (slack == 0 && !Exact(*meets_, near)) continue;
        solve::Answer answer = Ask(arena_.And(near), false);
        if (!std::holds_alternative<solve::Sat>(answer)) continue;
        decision_.verdict = verdict::Verdict::kRefuted;
        SetWitness(answer);
        return;
      }
    }
    HasNone(robot::LocalFormulas(arena_, point_, *meeting_));
    if (decision_.verdict == verdict::Verdict::kUnknown && meets_) SetWitness(*meets_);
    if (decision_.verdict == verdict::Verdict::kRefuted) {
      // The point is in coordinates of a shape; the whole formula knows it in those of the world.
      PointInWorld(whole);
    }
  }

  // Replaces `near` by the formula at the very values of an exact solution.
  bool Exact(const solve::Answer& answer, std::vector<TermId>& near) {
    const auto* sat = std::get_if<solve::Sat>(&answer);
    if (sat == nullptr || !sat->exact) return false;
    near.resize(1);
    for (const auto& [variable, value] : sat->values) {
      if (value.IsNumber())
        near.push_back(arena_.Eq(variable, arena_.Number(arena_.Real(), value.AsNumber())));
    }
    return true;
  }

  void PointInWorld(TermId whole) {
    const Numeric::Point local = decision_.witness.values;
    std::vector<TermId> near{whole};
    for (size_t i = 0; i + 3 < names_.size(); ++i) {
      const auto it = local.find(names_[i].first);
      if (it != local.end()) Near(names_[i].second, it->second, 1e-6, near);
    }
    solve::Answer answer = Ask(arena_.And(near), false);
    if (std::holds_alternative<solve::Sat>(answer)) return SetWitness(answer);
    if (std::holds_alternative<solve::DeltaSat>(answer)) {  // where shapes only touch
      const Numeric::Point nearly = PointOf(answer);
      for (size_t i = 0; i < 3; ++i) {
        const auto& [original, own] = names_[names_.size() - 3 + i];
        if (const auto it = nearly.find(own); it != nearly.end())
          decision_.witness.values[original] = it->second;
      }
      return;
    }
    for (size_t i = 0; i < 3; ++i) decision_.witness.values.erase(names_[names_.size() - 3 + i].first);
  }

  const Obligation& obligation_;
  const robot::World& world_;
  Arena arena_;
  Copy copy_;
  const solve::icp::Options& engine_;
  const Limits& limits_;
  base::StopToken::Clock::time_point deadline_;
  base::StopToken stop_;
  robot::Vector point_;
  std::optional<Meeting> meeting_;
  std::vector<std::pair<TermId, TermId>> names_;  // of the obligation's arena, of our own; the point last
  std::optional<solve::Answer> meets_;
  Decision decision_;
};

}  // namespace

Decision Decide(const Obligation& obligation, const robot::World& world, const Arena& arena,
                const solve::icp::Options& engine, const Limits& limits, const base::StopToken& stop) {
  return Deciding(obligation, world, arena, engine, limits, stop).Run();
}

}  // namespace rondo::choreo
