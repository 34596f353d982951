#include "reach/certify/follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kOrder = 9;        // of polynomials in time
constexpr size_t kPointOrder = 20;  // if the start is a single point
constexpr double kLeastStep = 1e-10;
constexpr size_t kMostSteps = 300'000;
constexpr size_t kMostMonomials = 1000;
constexpr size_t kMostHalves = 1000;  // of symbols

}  // namespace

bool Follower::Fail(std::string reason) {
  if (reason_.empty()) reason_ = fmt::format("{}, at {:.6g} s", std::move(reason), time_);
  return false;
}

// A symbol for each side that is not a point; copies of a state share its symbol.
Follower::Place Follower::Begin(const interval::Box& box, const interval::Box& recorded) {
  const size_t n = box.size();
  const auto& copies = system_.problem().copy_of;
  symbol_.assign(n, std::nullopt);
  symbols_ = 0;
  for (size_t i = 0; i < n; ++i) {
    if (i < copies.size() && copies[i]) continue;
    if (box[i].Width() > 1e-13 * Magnitude(box[i])) symbol_[i] = symbols_++;
  }
  for (size_t i = 0; i < copies.size(); ++i) {
    if (copies[i]) symbol_[i] = symbol_[*copies[i]];
  }
  order_ = symbols_ == 0 ? kPointOrder : kOrder;
  Place place;
  ReachSet& set = place.set;
  set.basis = bases_.Of(symbols_, 1);
  set.generators.resize(static_cast<Eigen::Index>(n), 0);
  Eigen::VectorXd thin = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (size_t i = 0; i < n; ++i) {
    const Interval side = box[i < copies.size() && copies[i] ? *copies[i] : i];
    std::vector<double>& p = set.polynomials.emplace_back(set.basis->size(), 0.0);
    p[0] = side.Middle();
    if (symbol_[i]) {
      p[1 + *symbol_[i]] = Radius(side);
      if (i < copies.size() && copies[i]) continue;
      const double radius = Radius(recorded[i]);
      place.recorded.push_back({(side.Middle() - recorded[i].Middle()) / radius, Radius(side) / radius});
    } else {
      thin[static_cast<Eigen::Index>(i)] = Radius(side);
    }
  }
  set.AddErrors(thin);
  return place;
}

std::string Follower::Run(const interval::Box& part, const interval::Box& recorded,
                          const std::vector<PartRecord::Step>& steps) {
  if (system_.IsEmpty(part)) return "";
  if (steps.empty()) return "a part of the initial set has no steps";
  hints_ = &steps;
  wanders_ = std::ranges::any_of(
      steps, [](const PartRecord::Step& s) { return s.kind == PartRecord::Step::Kind::kSeveral; });
  Place place = Begin(part, recorded);
  if (!Enter(place, {{system_.modes().start(), {}}})) return reason_;
  for (size_t c = 0; c < place.falls.size(); ++c) place.falls[c] = place.in->claims[c].starts_below;
  Follow(std::move(place));
  return reason_;
}

// In programs, discrete states are numbers or inputs. In sets they have a place, so that all states have one
// order.
void Follower::SetDiscrete(const ModeSystem& in, ReachSet& set) {
  Eigen::VectorXd thin = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set.states()));
  for (size_t i = 0; i < set.states(); ++i) {
    const auto& value = in.discrete[i];
    if (!value) continue;
    std::ranges::fill(set.polynomials[i], 0.0);
    set.polynomials[i][0] = value->Middle();
    set.generators.row(static_cast<Eigen::Index>(i)).setZero();
    thin[static_cast<Eigen::Index>(i)] = Radius(*value);
  }
  set.AddErrors(thin);
}

bool Follower::Enter(Place& place, std::vector<Possible> possible) {
  std::set<Mode> modes;
  for (const Possible& p : possible) modes.insert(p.mode);
  auto in = system_.For({modes.begin(), modes.end()});
  if (!in.ok()) return Fail(in.error().message);
  place.in = in.value();
  place.possible = std::move(possible);
  SetDiscrete(*place.in, place.set);
  place.falls.clear();
  for (const ModeClaim& claim : place.in->claims) place.falls.emplace_back(claim.starts_below.size(), false);
  return true;
}

// To the horizon.
bool Follower::Follow(Place place) {
  const std::vector<Rational>& instants = system_.instants();
  while (true) {
    if (place.met) {
      if (place.instant + 1 == instants.size()) {
        const interval::Box here = place.set.Box();
        if (end_.empty()) end_ = here;
        for (size_t i = 0; i < here.size(); ++i) end_[i] = interval::Hull(end_[i], here[i]);
        return true;
      }
      if (!Meet(place)) break;
    }
    if (stop_.StopRequested()) {
      Fail("stopped");
      break;
    }
    time_ = instants[place.instant + 1].ToDouble() - place.left.hi;
    const PartRecord::Step* hint = nullptr;
    if (!(place.carried > 0)) hint = &(*hints_)[std::min(next_hint_++, hints_->size() - 1)];
    using Kind = PartRecord::Step::Kind;
    if (hint != nullptr && hint->kind == Kind::kSplit) return Split(place, hint->symbol);
    if (hint != nullptr && hint->kind == Kind::kSeveral && !(hint->length > 0)) return Fork(place);
    if (!Advance(place, hint)) break;
    if (!place.met) continue;
    ++place.instant;
    time_ = instants[place.instant].ToDouble();
    if (!AtInstant(place, false)) break;
  }
  if (steps_ <= kMostSteps) last_ = std::move(place.set);  // else halves would take as many
  return false;
}

// What happens at an instant: the controller acts, events follow.
bool Follower::Meet(Place& place) {
  const std::vector<Rational>& instants = system_.instants();
  const Rational& now = instants[place.instant];
  if (system_.IsSample(now)) {
    Image image;
    if (!image.Of(place.in->control, place.set, place.in->dynamics.inputs))
      return Fail("the controller is not defined on the whole set");
    place.set = image.Set();
    for (Possible& p : place.possible) p.rising.clear();  // rates may jump
  }
  if (!Settle(place)) return false;
  if (place.instant == 0 && !AtInstant(place, true)) return false;
  place.left = Enclose(instants[place.instant + 1] - now);
  place.met = false;
  return true;
}

// Events that hold at an instant happen, one after the other, until none does. Where it is not certain
// whether they hold, both is possible.
bool Follower::Settle(Place& place) {
  for (size_t round = 0; round < kMostRounds; ++round) {
    if (place.in->guards.empty()) return true;
    Image image;
    if (!image.Of(place.in->observed, place.set, place.in->dynamics.inputs))
      return Fail("the condition of an event is not defined on the whole set");
    std::vector<Possible> next;
    const auto add = [&](Possible possible) {
      if (std::ranges::find(next, possible) == next.end()) next.push_back(std::move(possible));
    };
    for (const Possible& p : place.possible) {
      bool stays = true;
      for (const ModeGuard& guard : place.in->guards) {
        if (place.in->modes[guard.mode] != p.mode) continue;
        const auto range = [&](size_t atom) { return image.Range(guard.first + atom); };
        if (guard.formula.Check(range) != verdict::Truth::kFalse) add({guard.after, {}});
        stays = stays && !HoldsOn(guard, range);
      }
      if (stays) add(p);
    }
    if (next.size() > kMostPossible) return Fail("too many modes are possible");
    std::ranges::sort(next, {}, &Possible::mode);
    if (next == place.possible) return true;
    if (!Enter(place, std::move(next))) return false;
  }
  return Fail("events follow one another without end");
}

// One thing that the record says; `met` if the next instant is reached. Without a hint: the rest of a step.
bool Follower::Advance(Place& place, const PartRecord::Step* hint) {
  using Kind = PartRecord::Step::Kind;
  if (hint != nullptr && symbols_ > 0) {
    const size_t most = std::min(most_degree_, DegreeWithin(symbols_, kMostMonomials));
    const size_t degree = std::clamp<size_t>(hint->degree, 1, most);
    if (degree != place.set.basis->degree()) place.set.SetBasis(bases_.Of(symbols_, degree));
  }
  if (hint != nullptr && hint->kind == Kind::kCross) return Cross(place, *hint);
  if (hint != nullptr) place.open = hint->kind == Kind::kSeveral;
  double wanted = hint != nullptr ? hint->length : place.carried;
  if (steps_ > kMostSteps) return Fail("too many steps");
  if (!(wanted >= kLeastStep)) wanted = kLeastStep;
  // The last one ends where the next instant is, not a rounding before it.
  if (wanted > place.left.hi * (1 - 1e-9)) wanted = place.left.hi;
  return TakeStep(place, wanted);
}

// One step of the length that is wanted, or of a part of it.
bool Follower::TakeStep(Place& place, double wanted) {
  Step step(place.in->dynamics, order_);
  double taken = wanted;
  if (!Take(step, place.set, taken)) return false;
  Observation seen(*place.in, step);
  auto quiet = Quiet(place, seen);
  if (!quiet) {
    // Nearby the engine found it uncertain, too: only sooner or later.
    if (!place.open && !wanders_ && place.possible.size() == 1) return Fail("an event may happen");
    return Wander(place, wanted);
  }
  place.possible = std::move(*quiet);
  for (size_t c = 0; c < place.falls.size(); ++c) {
    for (size_t k = 0; k < place.falls[c].size(); ++k) {
      if (place.falls[c][k]) place.falls[c][k] = seen.StaysBelow(place.in->claims[c].first + k);
    }
  }
  return During(place, *place.in, seen) && GoOn(place, step, wanted, taken);
}

// Shortens the step until it can be taken.
bool Follower::Take(Step& step, const ReachSet& from, double& taken) {
  while (!step.Take(from, {taken, {}, 0})) {
    taken *= 0.5;
    if (taken < kLeastStep) return Fail("the set cannot be followed further");
  }
  ++steps_;
  return true;
}

// To the end of the step.
bool Follower::GoOn(Place& place, const Step& step, double wanted, double taken) {
  place.set = step.end();
  if (taken == place.left.hi) {
    // It lasted `left`, of which the upper end was taken.
    if (!place.left.IsPoint()) place.set.AddErrors(DistanceIn(Up(place.left.Width()), step.rates()));
    place.met = true;
    place.carried = 0;
  } else {
    place.left = place.left - Interval::Point(taken);
    place.carried = wanted - taken;
  }
  place.set.Reduce(ReachSet::MostColumns(place.set.states()));
  return true;
}

bool Follower::Split(const Place& place, size_t symbol) {
  if (symbol >= symbols_ || ++splits_ > kMostHalves) return Fail("no such part");
  for (const bool upper : {false, true}) {
    Place half = place;
    half.set = place.set.Half(symbol, upper);
    Scale& scale = half.recorded[symbol];
    const double middle = upper ? 0.5 : -0.5;  // of the half, in its symbol
    scale = {2 * (scale.offset + middle * scale.scale - middle), scale.scale};
    if (!Follow(std::move(half))) return false;
  }
  return true;
}

// Claims that hold at this instant only; at the start, all that begin there.
bool Follower::AtInstant(const Place& place, bool start) {
  const Rational& now = system_.instants()[place.instant];
  std::optional<Image> image;
  for (const ModeClaim& claim : place.in->claims) {
    if (claim.claim->from != now || !(start || claim.claim->to == now)) continue;
    if (!image) {
      image.emplace();
      if (!image->Of(place.in->observed, place.set, place.in->dynamics.inputs))
        return Fail("a claim is not defined on the whole set");
    }
    const verdict::Truth truth = claim.formula.Check([&](size_t atom) {
      const Interval range = image->Range(claim.first + atom);
      return (start && claim.starts_below[atom]) || claim.implied[atom] ? AtMostZero(range) : range;
    });
    if (truth != verdict::Truth::kTrue) return Fail(fmt::format("`{}` is not shown", claim.claim->name));
  }
  return true;
}

// Must the claim hold between the last instant and the next one?
bool Follower::IsDue(const Place& place, const ModeClaim& claim) const {
  const Rational& from = system_.instants()[place.instant];
  const Rational& to = system_.instants()[place.instant + 1];
  return claim.claim->from < to && from < claim.claim->to;
}

bool Follower::During(const Place& place, const ModeSystem& in, Observation& seen) {
  for (size_t c = 0; c < in.claims.size(); ++c) {
    const ModeClaim& claim = in.claims[c];
    if (!IsDue(place, claim)) continue;
    std::vector<bool> below = claim.implied;
    for (size_t k = 0; k < below.size() && &in == place.in.get(); ++k)
      below[k] = below[k] || place.falls[c][k];
    if (!seen.Holds(claim, below)) return Fail(fmt::format("`{}` is not shown", claim.claim->name));
  }
  return true;
}

// What bends the set most.
std::optional<size_t> Follower::WorstSide() const {
  std::vector<double> weight(symbols_);
  for (const std::vector<double>& p : last_.polynomials) {
    double size = 0;
    for (size_t m = 1; m < p.size(); ++m) size += std::fabs(p[m]);
    for (size_t m = 1; m < p.size(); ++m) {
      const auto exponents = last_.basis->Exponents(m);
      // A little of the linear part, too, so that something is split in any case.
      const double share =
          std::fabs(p[m]) / std::fmax(size, 1e-300) * (last_.basis->DegreeOf(m) > 1 ? 1 : 1e-3);
      for (size_t s = 0; s < symbols_; ++s) weight[s] += exponents[s] * share;
    }
  }
  const auto worst = std::ranges::max_element(weight);
  for (size_t i = 0; i < symbol_.size() && worst != weight.end(); ++i) {
    if (symbol_[i] && *symbol_[i] == static_cast<size_t>(worst - weight.begin())) return i;
  }
  return std::nullopt;
}

}  // namespace rondo::reach::certify
