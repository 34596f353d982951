#include "reach/invariants/find.h"

#include <algorithm>
#include <cmath>

#include "expr/substitute.h"
#include "reach/invariants/candidates.h"
#include "reach/invariants/nowhere.h"
#include "reach/invariants/terms.h"
#include "reach/problem/bounds.h"

namespace rondo::reach::invariants {

namespace {

constexpr size_t kMostModes = 32;
constexpr size_t kMostBoxes = 4000;  // to show that something always holds
constexpr size_t kFewBoxes = 400;    // to show that something never happens
constexpr double kNearby = 0x1p-20;  // how far around an invariant rates are looked at

// A comparison that may always hold in a mode: `term <= 0`.
struct Candidate {
  Conjunct conjunct;
  TermId term;
  TermId rate;  ///< its derivative in time
};

// An event that leads from a mode to another one.
struct Leaving {
  size_t to = 0;
  TermId condition;  ///< holds wherever the event can happen
};

// A mode, and what is still believed to hold in it.
struct Place {
  Mode mode;
  std::vector<TermId> rates;
  std::vector<Candidate> candidates;
  std::vector<Leaving> leaving;
  TermId stays;       ///< holds for as long as the mode lasts: else an event would have ended it
  interval::Box box;  ///< encloses where all of this holds; empty: not known yet
};

class Search {
 public:
  Search(const Problem& problem, Trajectories& trajectories, uint64_t seed, const base::StopToken& stop)
      : problem_(problem),
        arena_(*problem.arena),
        trajectories_(trajectories),
        seed_(seed),
        stop_(stop),
        variables_(problem.states) {
    for (const Input& input : problem.inputs) variables_.push_back(input.term);
  }

  std::optional<Found> Run() {
    auto modes = Modes::Of(problem_);
    if (!modes.ok()) return std::nullopt;
    modes_ = std::move(modes).value();
    if (!FindPlaces() || !Begin()) return std::nullopt;
    AddCandidates();
    do {
      changed_ = false;
      Enter();
      if (!Follow(places_[0], start_, first_box_, {0})) return std::nullopt;
      for (size_t p = 0; p < places_.size(); ++p) {
        const TermId here = Here(places_[p]);
        if (!Follow(places_[p], here, Box(places_[p]), {p})) return std::nullopt;
      }
      for (Place& place : places_) Keep(place);
      if (stop_.StopRequested()) return std::nullopt;
    } while (changed_);
    return Result();
  }

 private:
  TermId Zero() { return arena_.Number(arena_.Real(), Rational(0)); }
  TermId AtMost(TermId term, double bound = 0) {
    return arena_.Le(term, arena_.Number(arena_.Real(), Rational::FromDouble(bound)));
  }

  // All modes that events could lead to. False if there is something that is not understood.
  bool FindPlaces() {
    std::vector<Mode> all{modes_.start()};
    for (size_t at = 0; at < all.size(); ++at) {
      if (all.size() > kMostModes) return false;
      Place place{
          .mode = all[at], .rates = {}, .candidates = {}, .leaving = {}, .stays = arena_.True(), .box = {}};
      for (const TermId rate : problem_.rates) {
        place.rates.push_back(modes_.In(place.mode, rate));
        if (!IsContinuous(arena_, place.rates.back())) return false;
      }
      for (size_t e = 0; e < problem_.events.size(); ++e) {
        auto after = modes_.After(place.mode, e);
        if (!after.ok()) return false;
        if (after.value() == place.mode) continue;  // nothing happens
        const TermId condition = modes_.In(place.mode, problem_.events[e].condition);
        if (condition == arena_.False()) continue;
        auto to = std::ranges::find(all, after.value());
        if (to == all.end()) to = all.insert(to, after.value());
        place.leaving.push_back({static_cast<size_t>(to - all.begin()), Weakened(condition, false)});
        place.stays = arena_.And(place.stays, Weakened(condition, true));
      }
      places_.push_back(std::move(place));
    }
    return true;
  }

  // What holds where a condition begins to hold: its comparisons, or equality. Negated: what holds for as long as it does
  // not hold for any time: one of its comparisons fails, or is an equality.
  TermId Weakened(TermId condition, bool negated) {
    const auto normal = Normalise(arena_, condition);
    if (!normal.ok() || !IsContinuous(arena_, condition)) return arena_.True();
    return Weakened(normal.value(), normal.value().root, negated);
  }
  TermId Weakened(const Formula& formula, size_t node, bool negated) {
    const Formula::Node& n = formula.nodes[node];
    if (n.kind == Formula::Kind::kAtom) {
      const TermId term = formula.terms[n.atom];
      return AtMost(negated ? arena_.Neg(term) : term);
    }
    std::vector<TermId> parts;
    for (const size_t part : n.parts) parts.push_back(Weakened(formula, part, negated));
    return (n.kind == Formula::Kind::kAnd) != negated ? arena_.And(parts) : arena_.Or(parts);
  }

  // Where trajectories begin.
  bool Begin() {
    const TermId assume = modes_.In(modes_.start(), problem_.assume);
    const auto normal = Normalise(arena_, assume);
    if (!normal.ok() || arena_.IsPartial(assume)) return false;
    std::vector<TermId> all{Weakened(normal.value(), normal.value().root, false)};
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      if (std::isfinite(problem_.initial[i].hi))
        all.push_back(AtMost(problem_.states[i], problem_.initial[i].hi));
      if (std::isfinite(problem_.initial[i].lo))
        all.push_back(AtMost(arena_.Neg(problem_.states[i]), -problem_.initial[i].lo));
    }
    for (size_t i = 0; i < problem_.copy_of.size(); ++i) {
      if (problem_.copy_of[i])
        all.push_back(arena_.Eq(problem_.states[i], problem_.states[*problem_.copy_of[i]]));
    }
    start_ = arena_.And(all);
    first_box_ = problem_.initial;
    for (const Input& input : problem_.inputs) first_box_.push_back(input.bounds);
    return true;
  }

  void AddCandidates() {
    std::vector<Mode> all;
    for (const Place& place : places_) all.push_back(place.mode);
    const auto visited = Visited(problem_, modes_, all, trajectories_, seed_, stop_);
    for (size_t p = 0; p < places_.size(); ++p) {
      Place& place = places_[p];
      for (const Conjunct& conjunct : CandidatesFor(problem_, modes_, place.mode, visited[p])) {
        const auto term = TermOf(problem_, modes_, place.mode, conjunct);
        if (!term.ok() || arena_.IsNumber(term.value()) || !IsContinuous(arena_, term.value())) continue;
        const auto rate = RateOf(arena_, term.value(), problem_.states, place.rates);
        if (!rate ||
            std::ranges::find(place.candidates, term.value(), &Candidate::term) != place.candidates.end())
          continue;
        place.candidates.push_back({conjunct, term.value(), *rate});
      }
    }
  }

  TermId Here(const Place& place, double nearby = 0) {
    std::vector<TermId> all{place.stays};
    for (const Candidate& c : place.candidates) all.push_back(AtMost(c.term, nearby));
    return arena_.And(all);
  }

  interval::Box BoxOf(const Place& place, TermId where) {
    interval::Box box(problem_.states.size());
    for (size_t k = 0; k < modes_.states().size(); ++k)
      box[modes_.states()[k]] = Enclose(arena_.number(place.mode[k]));
    for (const Input& input : problem_.inputs) box.push_back(input.bounds);
    (void)Contract(arena_, where, variables_, box);
    return box;
  }
  const interval::Box& Box(Place& place) {
    if (place.box.empty()) place.box = BoxOf(place, Here(place));
    return place.box;
  }
  static bool IsEmpty(const interval::Box& box) {
    return std::ranges::any_of(box, [](const Interval& side) { return side.IsEmpty(); });
  }

  bool Never(TermId formula, const interval::Box& box, size_t most) {
    return IsEmpty(box) || HoldsNowhere(arena_, formula, variables_, box, most, stop_);
  }

  // Does `term <= 0` follow from one of these facts, by terms alone? Rounding says nothing of what is exactly so.
  bool Follows(TermId facts, TermId term) {
    const std::vector<TermId> all =
        arena_.op(facts) == expr::Op::kAnd
            ? std::vector<TermId>(arena_.args(facts).begin(), arena_.args(facts).end())
            : std::vector<TermId>{facts};
    return std::ranges::any_of(all, [&](TermId fact) {
      if (arena_.op(fact) != expr::Op::kLe) return false;
      const TermId distance = arena_.Sub(arena_.Sub(arena_.arg(fact, 0), arena_.arg(fact, 1)), term);
      return arena_.IsNumber(distance) && !(arena_.number(distance) < Rational(0));
    });
  }
  bool Always(TermId facts, TermId term, const interval::Box& box) {
    return Follows(facts, term) || Never(arena_.And(facts, arena_.Lt(Zero(), term)), box, kMostBoxes);
  }

  void Drop(Place& place, const std::function<bool(const Candidate&)>& is_kept) {
    const auto dropped = std::erase_if(place.candidates, [&](const Candidate& c) { return !is_kept(c); });
    if (dropped == 0) return;
    changed_ = true;
    place.box.clear();
  }

  // What holds at the start, in the mode that it begins in.
  void Enter() {
    Drop(places_[0], [&](const Candidate& c) { return Always(start_, c.term, first_box_); });
  }

  // Events that can happen at one instant, one after the other, from where `where` holds. False if the same
  // mode comes again: then there is no end to them, or it cannot be told.
  bool Follow(const Place& from, TermId where, const interval::Box& box, const std::vector<size_t>& path) {
    for (const Leaving& leaving : from.leaving) {
      const TermId there = arena_.And(where, leaving.condition);
      if (Never(there, box, kFewBoxes)) continue;
      if (std::ranges::find(path, leaving.to) != path.end()) return false;
      Place& to = places_[leaving.to];
      Drop(to, [&](const Candidate& c) { return Always(there, c.term, box); });
      std::vector<size_t> longer = path;
      longer.push_back(leaving.to);
      if (!Follow(to, there, box, longer)) return false;
    }
    return true;
  }

  // What the flow keeps.
  void Keep(Place& place) {
    if (place.candidates.empty() || IsEmpty(Box(place))) return;
    const TermId here = Here(place);
    const interval::Box box = Box(place);
    const TermId nearby = Here(place, kNearby);
    std::optional<interval::Box> around;
    Drop(place, [&](const Candidate& c) {
      if (arena_.IsNumber(c.rate) && !(Rational(0) < arena_.number(c.rate))) return true;
      if (FallsAtItsBoundary(c, here, box, place)) return true;
      if (!around) around = BoxOf(place, nearby);
      return Always(nearby, c.rate, *around);
    });
  }

  // Where the term is zero, it falls.
  bool FallsAtItsBoundary(const Candidate& c, TermId here, interval::Box box, const Place& place) {
    const TermId rises = AtMost(arena_.Neg(c.rate));
    std::optional<size_t> solved;
    std::optional<Line> line;
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      auto found = LineIn(arena_, c.term, problem_.states[i]);
      if (!found) continue;
      solved = i;
      line = std::move(found);
      if (place.rates[i] != Zero()) break;
    }
    if (!solved) return Never(arena_.And({here, AtMost(arena_.Neg(c.term)), rises}), box, kMostBoxes);
    const TermId factor = arena_.Number(arena_.Real(), Rational(-1) / line->slope);
    const expr::Substitution at_zero{{problem_.states[*solved], arena_.Mul(factor, line->rest)}};
    box[*solved] = Interval::Point(box[*solved].Middle());
    return Never(expr::Substitute(arena_, arena_.And(here, rises), at_zero), box, kMostBoxes);
  }

  std::optional<Found> Result() {
    Found found;
    found.states.assign(problem_.states.size(), Interval::Empty());
    for (Place& place : places_) {
      const interval::Box& box = Box(place);
      ModeInvariant& one = found.invariant.emplace_back();
      for (const TermId value : place.mode) one.mode.push_back(arena_.number(value));
      for (const Candidate& c : place.candidates) one.conjuncts.push_back(c.conjunct);
      if (IsEmpty(box)) continue;
      for (size_t i = 0; i < found.states.size(); ++i) {
        if (!std::isfinite(box[i].lo) || !std::isfinite(box[i].hi)) return std::nullopt;
        found.states[i] = interval::Hull(found.states[i], box[i]);
      }
    }
    for (size_t c = 0; c < problem_.claims.size(); ++c) {
      const bool implied = std::ranges::all_of(
          places_, [&](Place& place) { return Implies(place, problem_.claims[c].formula); });
      if (implied) found.claims.push_back(c);
    }
    if (found.claims.empty()) return std::nullopt;
    return found;
  }

  bool Implies(Place& place, TermId formula) {
    const TermId claim = modes_.In(place.mode, formula);
    const auto normal = Normalise(arena_, claim);
    if (!normal.ok() || !IsContinuous(arena_, claim)) return false;
    const TermId here = Here(place);
    const TermId open = Open(normal.value(), normal.value().root, here);
    return Never(arena_.And(here, arena_.Not(open)), Box(place), kMostBoxes);
  }
  // A formula without the comparisons that follow from facts by terms alone.
  TermId Open(const Formula& formula, size_t node, TermId facts) {
    const Formula::Node& n = formula.nodes[node];
    if (n.kind == Formula::Kind::kAtom) {
      const TermId term = formula.terms[n.atom];
      if (n.strict) return arena_.Lt(term, Zero());
      return Follows(facts, term) ? arena_.True() : arena_.Le(term, Zero());
    }
    std::vector<TermId> parts;
    for (const size_t part : n.parts) parts.push_back(Open(formula, part, facts));
    return n.kind == Formula::Kind::kAnd ? arena_.And(parts) : arena_.Or(parts);
  }

  const Problem& problem_;
  expr::Arena& arena_;
  Trajectories& trajectories_;
  uint64_t seed_;
  const base::StopToken& stop_;
  std::vector<TermId> variables_;
  Modes modes_;
  std::vector<Place> places_;
  TermId start_;
  interval::Box first_box_;
  bool changed_ = false;
};

}  // namespace

std::optional<Found> Find(const Problem& problem, Trajectories& trajectories, uint64_t seed,
                          const base::StopToken& stop) {
  if (problem.events.empty() || problem.controller) return std::nullopt;
  return Search(problem, trajectories, seed, stop).Run();
}

}  // namespace rondo::reach::invariants
