#include "reach/certify/invariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "reach/certify/gradient.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

using verdict::Truth;

constexpr size_t kMostBoxes = 100'000;  // for one thing that is to be shown
constexpr size_t kFewBoxes = 3'000;     // for what may well not be so
constexpr double kAround = 0x1p-24;     // how far around an invariant rates are looked at, if need be

// What leads out of a mode.
struct Way {
  size_t to = 0;  ///< the place; SIZE_MAX if the invariant does not mention it
  Formula condition;
  size_t first = 0;    ///< where its terms begin among the outputs of the program
  bool known = false;  ///< whether all of its terms are continuous: else nothing is said about where it holds
};

// A mode as the invariant has it. Outputs of the program: rates, conjuncts, conditions, claims.
struct Place {
  Mode mode;
  std::vector<TermId> terms;  ///< of conjuncts: each is at most zero
  std::vector<Way> ways;
  std::vector<std::pair<size_t, Formula>> claims;  ///< where their terms begin, as in the problem
  Program program;
  interval::Box box;  ///< encloses where the conjuncts hold
};

// Many trajectories at one instant: where they come from and what has happened.
struct Chain {
  const Place* from;
  bool at_start = false;  ///< of the problem; else in the midst of the mode
  std::vector<const Way*> ways;
  std::vector<size_t> places;
};

class Checking {
 public:
  Checking(const Problem& problem, const base::StopToken& stop)
      : problem_(problem), arena_(*problem.arena), stop_(stop), variables_(problem.states) {
    for (const Input& input : problem.inputs) variables_.push_back(input.term);
  }

  base::Result<Invariance> Run(const Invariant& invariant) {
    if (problem_.controller) return base::Error{"an invariant of modes says nothing about a controller"};
    auto modes = Modes::Of(problem_);
    if (!modes.ok()) return modes.error();
    modes_ = std::move(modes).value();
    if (const std::string wrong = Compile(invariant); !wrong.empty()) return base::Error{wrong};
    if (!EnclosePlaces()) return base::Error{"the invariant is not bounded"};
    if (const std::string wrong = CheckStart(); !wrong.empty()) return base::Error{wrong};
    for (const Place& place : places_) {
      const std::string wrong = CheckPlace(place);
      if (!wrong.empty()) return base::Error{fmt::format("{} ({})", wrong, modes_.ToText(place.mode))};
    }
    Invariance result;
    for (size_t c = 0; c < problem_.claims.size(); ++c) {
      if (std::ranges::all_of(places_, [&](const Place& place) { return Implies(place, c); }))
        result.claims.push_back(c);
    }
    if (stop_.StopRequested()) return base::Error{"stopped"};
    result.boxes = boxes_;
    return result;
  }

 private:
  // -- what there is to show

  std::string Compile(const Invariant& invariant) {
    for (const ModeInvariant& one : invariant) {
      Place& place = places_.emplace_back();
      if (one.mode.size() != modes_.states().size()) return "a mode of the invariant is none of the problem";
      for (const Rational& value : one.mode) place.mode.push_back(arena_.Number(arena_.Real(), value));
      for (const Conjunct& conjunct : one.conjuncts) {
        auto term = TermOf(problem_, modes_, place.mode, conjunct);
        if (!term.ok()) return term.error().message;
        place.terms.push_back(term.value());
      }
    }
    for (size_t a = 0; a < places_.size(); ++a) {
      if (PlaceOf(places_[a].mode) != a) return "the invariant mentions a mode twice";
    }
    for (Place& place : places_) {
      if (const std::string wrong = CompilePlace(place); !wrong.empty()) return wrong;
    }
    if (PlaceOf(modes_.start()) == SIZE_MAX) return "the invariant does not mention the first mode";
    auto normal = Normalise(arena_, arena_.And(modes_.In(modes_.start(), problem_.assume), InFirstBox()));
    if (!normal.ok()) return normal.error().message;
    assumed_ = std::move(normal).value();
    auto terms = reach::Compile(arena_, variables_, assumed_.terms);
    if (!terms.ok()) return terms.error().message;
    assumed_terms_ = std::move(terms).value();
    return "";
  }

  std::string CompilePlace(Place& place) {
    std::vector<TermId> outputs;
    for (const TermId rate : problem_.rates) outputs.push_back(modes_.In(place.mode, rate));
    outputs.insert(outputs.end(), place.terms.begin(), place.terms.end());
    const auto add = [&](TermId formula, Formula& normal) -> base::Result<size_t> {
      auto made = Normalise(arena_, modes_.In(place.mode, formula));
      if (!made.ok()) return made.error();
      normal = std::move(made).value();
      const size_t first = outputs.size();
      outputs.insert(outputs.end(), normal.terms.begin(), normal.terms.end());
      return first;
    };
    for (size_t e = 0; e < problem_.events.size(); ++e) {
      const auto after = modes_.After(place.mode, e);
      if (!after.ok()) return after.error().message;
      if (after.value() == place.mode) continue;  // nothing happens
      Way way{.to = PlaceOf(after.value()), .condition = {}, .first = 0, .known = false};
      const auto first = add(problem_.events[e].condition, way.condition);
      if (!first.ok()) return first.error().message;
      way.first = first.value();
      place.ways.push_back(std::move(way));
    }
    for (const Claim& claim : problem_.claims) {
      Formula normal;
      const auto first = add(claim.formula, normal);
      if (!first.ok()) return first.error().message;
      place.claims.emplace_back(first.value(), std::move(normal));
    }
    auto program = reach::Compile(arena_, variables_, outputs);
    if (!program.ok()) return program.error().message;
    place.program = std::move(program).value();
    for (size_t i = 0; i < problem_.states.size() + place.terms.size(); ++i) {
      if (!IsContinuous(place.program, place.program.outputs[i])) return "a rate or a term may jump";
    }
    for (Way& way : place.ways) way.known = AllContinuous(place, way.first, way.condition);
    return "";
  }

  // As terms: rounding says nothing of a bound that is met exactly.
  TermId InFirstBox() {
    std::vector<TermId> all;
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      const Interval side = problem_.initial[i];
      const auto number = [&](double value) {
        return arena_.Number(arena_.Real(), Rational::FromDouble(value));
      };
      if (std::isfinite(side.lo)) all.push_back(arena_.Le(number(side.lo), problem_.states[i]));
      if (std::isfinite(side.hi)) all.push_back(arena_.Le(problem_.states[i], number(side.hi)));
    }
    return arena_.And(all);
  }

  static bool AllContinuous(const Place& place, size_t first, const Formula& formula) {
    for (size_t k = 0; k < formula.terms.size(); ++k) {
      if (!IsContinuous(place.program, place.program.outputs[first + k])) return false;
    }
    return true;
  }

  size_t PlaceOf(const Mode& mode) const {
    const auto it = std::ranges::find(places_, mode, &Place::mode);
    return it == places_.end() ? SIZE_MAX : static_cast<size_t>(it - places_.begin());
  }

  // Boxes around the conjuncts, and a little more: rates are looked at nearby, too.
  bool EnclosePlaces() {
    for (Place& place : places_) {
      std::vector<TermId> all;
      for (const TermId term : place.terms)
        all.push_back(arena_.Le(term, arena_.Number(arena_.Real(), Rational::FromDouble(2 * kAround))));
      place.box.resize(problem_.states.size());
      for (size_t k = 0; k < modes_.states().size(); ++k)
        place.box[modes_.states()[k]] = Enclose(arena_.number(place.mode[k]));
      for (const Input& input : problem_.inputs) place.box.push_back(input.bounds);
      (void)Contract(arena_, arena_.And(all), variables_, place.box);
      if (IsEmpty(place.box)) continue;
      for (const Interval& side : place.box) {
        if (!std::isfinite(side.lo) || !std::isfinite(side.hi)) return false;
      }
    }
    return true;
  }

  static bool IsEmpty(const interval::Box& box) {
    return std::ranges::any_of(box, [](const Interval& side) { return side.IsEmpty(); });
  }

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
    (void)Contract(arena_, arena_.Le(zero, term), variables_, box);
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
      if (CheckBox(assumed_terms_, assumed_, box) == Truth::kFalse) return false;
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
      known = Necessary(assumed_);
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
    const Place& first = places_[PlaceOf(modes_.start())];
    interval::Box box = problem_.initial;
    for (const Input& input : problem_.inputs) box.push_back(input.bounds);
    Chain chain{.from = &first, .at_start = true, .ways = {}, .places = {PlaceOf(modes_.start())}};
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
    return CheckEvents({.from = &place, .at_start = false, .ways = {}, .places = {PlaceOf(place.mode)}},
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
    if (!AllContinuous(place, first, formula)) return false;
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
  const base::StopToken& stop_;
  std::vector<TermId> variables_;
  Modes modes_;
  std::vector<Place> places_;
  Formula assumed_;
  Program assumed_terms_;
  size_t boxes_ = 0;
};

}  // namespace

base::Result<Invariance> CheckInvariant(const Problem& problem, const Invariant& invariant,
                                        const base::StopToken& stop) {
  return Checking(problem, stop).Run(invariant);
}

}  // namespace rondo::reach::certify
