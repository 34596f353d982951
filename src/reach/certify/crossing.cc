// Events that all of a set meets.
#include <cmath>
#include <map>
#include <numeric>

#include "reach/certify/follower.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

constexpr double kFirstShare = 0.25;    // of a stretch of time, for a step
constexpr double kSmallShare = 0x1p-9;  // is not made smaller to lose less
constexpr double kLeastShare = 0x1p-24;
constexpr double kMostAdded = 1e-2;  // to errors, relative to the set, by all of a stretch
constexpr int kMostAttempts = 20;

// Does the step add more to the errors than its share?
bool IsCrude(const ReachSet& set, const Step& step, double share) {
  const interval::Box box = set.Box();
  for (size_t i = 0; i < set.states(); ++i) {
    if (step.added()[static_cast<Eigen::Index>(i)] >
        kMostAdded * share * box[i].Width() + 1e-13 * Magnitude(box[i]))
      return true;
  }
  return false;
}

}  // namespace

// With a time q(s) for each start: the flow of q f over one unit of time leads to about where the condition
// begins to hold. A trajectory meets it at most |g| / m sooner or later, where g is its term there and -m
// bounds g' all around; so after q(s), every trajectory is one of the mode after, from a state that is at
// most |g| / m * |f - f'| away. After some more time for all, the flow of (W - q) f' leads them to one
// instant.
bool Follower::Cross(Place& place, const PartRecord::Step& record) {
  const ModeGuard* guard = nullptr;
  for (const ModeGuard& g : place.in->guards) {
    if (g.event == record.event) guard = &g;
  }
  if (guard == nullptr || place.possible.size() != 1) return Fail("there is no such event");
  const double window = record.length;
  if (!(window > 0) || !(record.together >= 0)) return Fail("an event takes no time");
  const Interval left = place.left - Interval::Point(window) - Interval::Point(record.together);
  if (!(left.lo > 0)) return Fail("an event lasts beyond an instant");
  Pace to_event{1, std::vector<double>(place.set.basis->size()), 0};
  for (const auto& [exponents, factor] : record.time) {
    if (exponents.size() == symbols_) AddTime(place, exponents, factor, to_event.polynomial);
  }
  Pace rest = to_event;
  for (double& x : rest.polynomial) x = -x;
  const double at = to_event.polynomial[0];
  rest.polynomial[0] = window - at;
  rest.error = Up(Gamma(2) * (window + std::fabs(at)));
  for (std::vector<bool>& f : place.falls) f.assign(f.size(), false);
  Event event{place.in, guard};
  if (!Move(place, to_event, event) || !Switch(place, event)) return false;
  if (record.together > 0 && !Move(place, {record.together, {}, 0}, event)) return false;
  if (!Move(place, rest, event)) return false;
  place.left = left;
  place.carried = 0;
  return true;
}

// A monomial in the symbols of the record, in ours: whatever it comes to would do.
void Follower::AddTime(const Place& place, const std::vector<uint32_t>& exponents, double factor,
                       std::vector<double>& time) const {
  const uint64_t degree = std::accumulate(exponents.begin(), exponents.end(), uint64_t{0});
  if (degree > place.set.basis->degree()) return;
  std::map<std::vector<uint32_t>, double> parts{{std::vector<uint32_t>(symbols_), factor}};
  for (size_t s = 0; s < symbols_; ++s) {
    const auto [offset, scale] = place.recorded[s];
    for (uint32_t power = 0; power < exponents[s]; ++power) {
      std::map<std::vector<uint32_t>, double> product;  // times offset + scale * symbol
      for (const auto& [own, part] : parts) {
        auto higher = own;
        ++higher[s];
        product[own] += part * offset;
        product[higher] += part * scale;
      }
      parts = std::move(product);
    }
  }
  for (const auto& [own, part] : parts) {
    if (const auto monomial = place.set.basis->Find(own)) time[*monomial] += part;
  }
}

// Does the guard of the mode after lead back, and hold for the instant of the event at most, if its term
// rises then? Back in the mode before, the event would follow at once.
bool Follower::Returns(const Event& event, const ModeGuard& guard) {
  return event.term && guard.IsComparison() && guard.after == event.before->modes[0] &&
         system_.AreOpposite(guard.formula.terms[0], event.guard->formula.terms[*event.term]);
}

// Follows the set for all of the pace, in steps. No event happens but, perhaps, the one that is expected:
// then one of its terms decides, and falls. Afterwards, its negation rises until it is certain.
bool Follower::Move(Place& place, const Pace& whole, Event& event) {
  double share = kFirstShare;
  for (double done = 0; done < 1;) {  // shares are powers of two: sums are exact
    if (stop_.StopRequested()) return Fail("stopped");
    Step step(place.in->dynamics, order_);
    while (!step.Take(place.set, {whole.length * share, whole.polynomial, whole.error}) ||
           (share > kSmallShare && IsCrude(place.set, step, share))) {
      share *= 0.5;
      if (share < kLeastShare) return Fail("the set cannot be followed through an event");
    }
    ++steps_;
    Observation seen(*place.in, step);
    for (const ModeGuard& guard : place.in->guards) {
      if (seen.IsFalse(guard)) continue;
      if (place.in != event.before && Returns(event, guard) && seen.Slope(guard.first).lo > 0) continue;
      if (&guard != event.guard) return Fail("another event may happen");
      const auto ranges = seen.RangesOf(guard);
      if (!event.term) event.term = guard.formula.Deciding(ranges);
      if (!event.term || !guard.formula.ComesDownTo(*event.term, ranges))
        return Fail("several comparisons decide an event");
      const double falls = -seen.Slope(guard.first + *event.term).hi;
      if (!(falls > 0)) return Fail("an event is not met transversally");
      event.slope = std::fmin(event.slope, falls);
    }
    if (!During(place, *place.in, seen)) return false;
    place.set = step.end();
    place.set.Reduce(ReachSet::MostColumns(place.set.states()));
    done += share;
    if (share < kFirstShare && std::fmod(done, 2 * share) == 0) share *= 2;
  }
  return true;
}

// From the mode before to the one after.
bool Follower::Switch(Place& place, const Event& event) {
  const ModeSystem& before = *place.in;
  const ModeGuard& guard = *event.guard;
  if (!event.term) return Fail("an event does not happen");
  const size_t output = guard.first + *event.term;
  const auto made = system_.For({guard.after});
  if (!made.ok()) return Fail(made.error().message);
  const ModeSystem& after = *made.value();
  const size_t n = place.set.states();
  Image image;
  if (!image.Of(before.observed, place.set, before.dynamics.inputs))
    return Fail("the condition of an event is not defined");
  const double term = Magnitude(image.Range(output));
  // A box that no trajectory leaves within twice the time by which the event may be early or late.
  const interval::Box start = place.set.Box();
  interval::Box box = start;
  interval::Box rates(n);
  interval::Box jumps(n);
  double late = 0;
  bool inside = false;
  for (int attempt = 0; attempt < kMostAttempts && !inside; ++attempt) {
    interval::Box all = box;
    all.insert(all.end(), before.dynamics.inputs.begin(), before.dynamics.inputs.end());
    OnBox on_before;
    OnBox on_after;
    OnBox on_terms;
    OnBox on_guards;
    if (!Linearise(before.dynamics.rates, all, 0, on_before) ||
        !Linearise(after.dynamics.rates, all, 0, on_after) ||
        !Linearise(before.observed, all, before.observed.outputs.size(), on_terms) ||
        !Linearise(after.observed, all, after.observed.outputs.size(), on_guards))
      return Fail("something is not defined around an event");
    interval::Box own(n);
    interval::Box other(n);
    for (size_t i = 0; i < n; ++i) {
      own[i] = on_before.values[before.dynamics.rates.outputs[i]];
      other[i] = on_after.values[after.dynamics.rates.outputs[i]];
      jumps[i] = own[i] - other[i];
      rates[i] = interval::Hull(own[i], other[i]);
    }
    for (const ModeGuard& g : after.guards) {
      if (Returns(event, g) && !(SlopeOf(on_guards, g.first, after.observed.variables.size(), other).lo > 0))
        return Fail("an event may be taken back");
    }
    const double falls =
        std::fmin(event.slope, -SlopeOf(on_terms, output, before.observed.variables.size(), own).hi);
    if (!(falls > 0)) return Fail("an event is not met transversally");
    late = Up(Up(term) / falls);
    inside = true;
    for (size_t i = 0; i < n; ++i) {
      const Interval reached = start[i] + Around(2 * late) * rates[i];
      if (!IsFinite(reached)) return Fail("an event is not met transversally");
      if (box[i].Contains(reached)) continue;
      inside = false;
      box[i] = reached + Around(0.1 * reached.Width() + 0x1p-900);
    }
  }
  if (!inside) return Fail("an event is not met transversally");
  // What holds meanwhile.
  ReachSet around = place.set;
  around.AddErrors(DistanceIn(2 * late, rates));
  if (!HoldsAround(place, before, around, event) || !HoldsAround(place, after, around, event)) return false;
  place.set.AddErrors(DistanceIn(late, jumps));
  return Enter(place, {{guard.after, {}}});
}

// Do all claims hold there, and no event but the one that is met?
bool Follower::HoldsAround(const Place& place, const ModeSystem& in, const ReachSet& set,
                           const Event& event) {
  Image image;
  if (!image.Of(in.observed, set, in.dynamics.inputs)) return Fail("a claim is not defined at an event");
  const auto range = [&](size_t output) { return image.Range(output); };
  for (const ModeGuard& guard : in.guards) {
    const auto own = [&](size_t atom) { return range(guard.first + atom); };
    if (&guard == event.guard) {
      if (!guard.formula.ComesDownTo(*event.term, own)) return Fail("several comparisons decide an event");
    } else if (&in != event.before.get() && Returns(event, guard)) {
      continue;  // Switch has looked at it
    } else if (guard.formula.Check(own) != verdict::Truth::kFalse) {
      return Fail("another event may happen");
    }
  }
  for (const ModeClaim& claim : in.claims) {
    if (!IsDue(place, claim)) continue;
    const verdict::Truth truth = claim.formula.Check([&](size_t atom) {
      return claim.implied[atom] ? AtMostZero(range(claim.first + atom)) : range(claim.first + atom);
    });
    if (truth != verdict::Truth::kTrue) return Fail("`" + claim.claim->name + "` is not shown");
  }
  return true;
}

}  // namespace rondo::reach::certify
