#include "reach/certify/invariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "reach/certify/gradient.h"
#include "reach/certify/places.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

using verdict::Truth;

constexpr size_t kMostBoxes = 100'000;  // for one thing that is to be shown
constexpr size_t kFewBoxes = 3'000;     // for what may well not be so

bool IsEmpty(const interval::Box& box) {
  return std::ranges::any_of(box, [](const Interval& side) { return side.IsEmpty(); });
}

// Many trajectories at one instant: where they come from and what has happened.
struct Chain {
  const Place* from;
  bool at_start = false;  ///< of the problem; else in the midst of the mode
  std::vector<const Way*> ways;
  std::vector<size_t> places;
};

class Checking {
 public:
  Checking(const Problem& problem, const Places& places, const base::StopToken& stop)
      : problem_(problem), arena_(*problem.arena), places_(places), stop_(stop) {}

  base::Result<Invariance> Run() {
    if (const std::string wrong = CheckStart(); !wrong.empty()) return base::Error{wrong};
    for (const Place& place : places_.all()) {
      const std::string wrong = CheckPlace(place);
      if (!wrong.empty())
        return base::Error{fmt::format("{} ({})", wrong, places_.modes().ToText(place.mode))};
    }
    Invariance result;
    for (size_t c = 0; c < problem_.claims.size(); ++c) {
      if (std::ranges::all_of(places_.all(), [&](const Place& place) { return Implies(place, c); }))
        result.claims.push_back(c);
    }
    if (stop_.StopRequested()) return base::Error{"stopped"};
    result.boxes = boxes_;
    return result;
  }

 private:
  // -- how it is shown

  // Says `is_shown` of some boxes that make up this one.
  bool Everywhere(const interval::Box& box, size_t most,
                  const std::function<bool(const interval::Box&)>& is_shown) {
    if (IsEmpty(box)) return true;
    std::vector<interval::Box> open{box};
    for (size_t count = 0; !open.empty(); ++count, ++boxes_) {
      if (count == most || stop_.StopRequested()) return false;
      interval::Box part = std::move(open.back());
      open.pop_back();
      if (is_shown(part)) continue;
      size_t widest = 0;
      double share = 0;
      for (size_t i = 0; i < part.size(); ++i) {
        const double own = box[i].Width() > 0 ? part[i].Width() / box[i].Width() : 0;
        if (own > share) {
          share = own;
          widest = i;
        }
      }
      if (share < 1e-7) return false;
      const double middle = part[widest].Middle();
      open.push_back(part);
      open.back()[widest].lo = middle;
      part[widest].hi = middle;
      open.push_back(std::move(part));
    }
    return true;
  }

  // Cuts off what is certainly below zero: only the rest matters.
  interval::Box WhereNotBelow(TermId term, interval::Box box) const {
    const TermId zero = arena_.Number(arena_.Real(), Rational(0));
    (void)Contract(arena_, arena_.Le(zero, term), places_.variables(), box);
    return box;
  }

  using Values = std::vector<Interval>;

  Interval TermOn(const Place& place, const Values& values, size_t k) const {
    return values[place.program.outputs[problem_.states.size() + k]];
  }

  // May the mode last anywhere in the box? All conjuncts hold, up to `more`, and no condition holds in all of it.
  bool MayBeIn(const Place& place, const Values& values, double more) const {
    for (size_t k = 0; k < place.terms.size(); ++k) {
      if (TermOn(place, values, k).lo > more) return false;
    }
    return std::ranges::none_of(place.ways, [&](const Way& way) {
      // Strictly, even if equality would do: then the condition holds nearby, too.
      return way.known && way.condition.Check([&](size_t k) {
        const Interval range = values[place.program.outputs[way.first + k]];
        return range.hi < 0 ? range : Interval{range.lo, std::max(range.hi, 1.0)};
      }) == Truth::kTrue;
    });
  }

  // May the condition begin to hold anywhere in the box? Where it does its comparisons hold, or are equalities.
  static bool MayHappen(const Way& way, const Place& place, const Values& values) {
    return !way.known || way.condition.Check([&](size_t k) {
      const Interval range = values[place.program.outputs[way.first + k]];
      return range.lo > 0 ? range : Interval{std::min(range.lo, -1.0), range.hi};
    }) != Truth::kFalse;
  }

  // May any trajectory of the chain be in the box?
  bool MayBe(const Chain& chain, const interval::Box& box) const {
    const Values values = ValuesOn(chain.from->program, box);
    if (chain.at_start) {
      if (CheckBox(places_.assumed_terms(), places_.assumed(), box) == Truth::kFalse) return false;
    } else if (!MayBeIn(*chain.from, values, 0)) {
      return false;
    }
    for (size_t k = 0; k < chain.ways.size(); ++k) {
      const Place& place = places_[chain.places[k]];
      if (!MayHappen(*chain.ways[k], place, k == 0 ? values : ValuesOn(place.program, box))) return false;
    }
    return true;
  }

  // What is known to be at most zero, as terms.
  std::vector<TermId> Known(const Chain& chain) const {
    std::vector<TermId> known;
    if (chain.at_start) {
      known = Necessary(places_.assumed());
    } else {
      known = Lasting(*chain.from);
    }
    for (const Way* way : chain.ways) {
      if (!way->known) continue;
      for (const TermId term : Necessary(way->condition)) known.push_back(term);
    }
    return known;
  }
  std::vector<TermId> Lasting(const Place& place) const {
    std::vector<TermId> known = place.terms;
    for (const Way& way : place.ways) {
      const bool single = way.condition.nodes[way.condition.root].kind == Formula::Kind::kAtom;
      if (way.known && single) known.push_back(arena_.Neg(way.condition.terms[0]));
    }
    return known;
  }
  // Is it at most one of these, by terms alone?
  bool Follows(TermId term, const std::vector<TermId>& known) const {
    return std::ranges::any_of(known, [&](TermId other) {
      const TermId distance = arena_.Sub(other, term);
      return arena_.IsNumber(distance) && !(arena_.number(distance) < Rational(0));
    });
  }

  // -- the conditions

  std::string CheckStart() {
    const Place& first = places_[places_.first()];
    interval::Box box = problem_.initial;
    for (const Input& input : problem_.inputs) box.push_back(input.bounds);
    Chain chain{.from = &first, .at_start = true, .ways = {}, .places = {places_.first()}};
    if (!Entered(chain, first, box)) return "the invariant may not hold at the start";
    return CheckEvents(chain, box);
  }

  // Do the conjuncts of a mode hold wherever a chain leads into it?
  bool Entered(const Chain& chain, const Place& to, const interval::Box& box) {
    const std::vector<TermId> known = Known(chain);
    for (size_t k = 0; k < to.terms.size(); ++k) {
      if (Follows(to.terms[k], known)) continue;
      const bool shown =
          Everywhere(WhereNotBelow(to.terms[k], box), kMostBoxes, [&](const interval::Box& part) {
            return TermOn(to, ValuesOn(to.program, part), k).hi <= 0 || !MayBe(chain, part);
          });
      if (!shown) return false;
    }
    return true;
  }

  // Every sequence of events at one instant: each keeps the invariant, and none goes on without end.
  std::string CheckEvents(const Chain& chain, const interval::Box& box) {
    for (const Way& way : places_[chain.places.back()].ways) {
      Chain longer = chain;
      longer.ways.push_back(&way);
      const bool never =
          Everywhere(box, kFewBoxes, [&](const interval::Box& part) { return !MayBe(longer, part); });
      if (never) continue;
      if (way.to == SIZE_MAX) return "an event leads to a mode that the invariant does not mention";
      if (std::ranges::find(chain.places, way.to) != chain.places.end())
        return "events may follow one another without end";
      if (!Entered(longer, places_[way.to], box)) return "an event may break the invariant";
      longer.places.push_back(way.to);
      if (std::string wrong = CheckEvents(longer, box); !wrong.empty()) return wrong;
    }
    return "";
  }

  std::string CheckPlace(const Place& place) {
    if (IsEmpty(place.box)) return "";
    for (size_t k = 0; k < place.terms.size(); ++k) {
      if (!IsKept(place, k)) return "the flow may break the invariant";
    }
    return CheckEvents({.from = &place, .at_start = false, .ways = {}, .places = {places_.Find(place.mode)}},
                       place.box);
  }

  Interval RateOf(const Place& place, const Values& values, size_t k) const {
    const size_t n = problem_.states.size();
    const auto gradient = GradientOn(place.program, values, place.program.outputs[n + k], n);
    Interval rate = Interval::Point(0);
    for (size_t i = 0; i < n; ++i) {
      if (gradient[i] != Interval::Point(0)) rate = rate + gradient[i] * values[place.program.outputs[i]];
    }
    return rate;
  }

  // A term falls wherever it is zero and the invariant holds; or it does not rise anywhere near the invariant.
  bool IsKept(const Place& place, size_t k) {
    const bool falls =
        Everywhere(WhereNotBelow(place.terms[k], place.box), kMostBoxes, [&](const interval::Box& part) {
          const Values values = ValuesOn(place.program, part);
          return !TermOn(place, values, k).Contains(0) || RateOf(place, values, k).hi < 0 ||
                 !MayBeIn(place, values, 0);
        });
    if (falls) return true;
    return Everywhere(place.box, kMostBoxes, [&](const interval::Box& part) {
      const Values values = ValuesOn(place.program, part);
      return RateOf(place, values, k).hi <= 0 || !MayBeIn(place, values, kAround);
    });
  }

  bool Implies(const Place& place, size_t claim) {
    const auto& [first, formula] = place.claims[claim];
    if (!Places::AreContinuous(place, first, formula)) return false;
    const std::vector<TermId> known = Lasting(place);
    std::vector<bool> follows;
    for (const TermId term : formula.terms) follows.push_back(Follows(term, known));
    return Everywhere(place.box, kMostBoxes, [&](const interval::Box& part) {
      const Values values = ValuesOn(place.program, part);
      return formula.Check([&](size_t k) {
        const Interval range = values[place.program.outputs[first + k]];
        return follows[k] ? Interval{std::min(range.lo, 0.0), std::min(range.hi, 0.0)} : range;
      }) == Truth::kTrue ||
             !MayBeIn(place, values, 0);
    });
  }

  const Problem& problem_;
  expr::Arena& arena_;
  const Places& places_;
  const base::StopToken& stop_;
  size_t boxes_ = 0;
};

}  // namespace

base::Result<Invariance> CheckInvariant(const Problem& problem, const Invariant& invariant,
                                        const base::StopToken& stop) {
  if (problem.controller) return base::Error{"an invariant of modes says nothing about a controller"};
  const auto places = Places::Of(problem, invariant);
  if (!places.ok()) return places.error();
  return Checking(problem, places.value(), stop).Run();
}

}  // namespace rondo::reach::certify
