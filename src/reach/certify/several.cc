// Several modes are possible at once: it is not certain which events happen.
//
// A trajectory is in a mode for some time, or leaves it at the instant at which it enters it. While it is in
// a mode, no condition of the mode's events holds for longer than an instant: a term h with the condition `h
// <= 0` or `h < 0` is not negative, nor zero for longer than an instant. So an event that ends some time in a
// mode does it where h falls to zero.
#include <algorithm>

#include "reach/certify/follower.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kMostForks = 64;

}  // namespace

// What is possible after a step during which no event happens; nothing if one may. Of what rises, only that
// is known afterwards which is known to go on rising.
std::optional<std::vector<Follower::Possible>> Follower::Quiet(const Place& place, Observation& seen) {
  const ModeSystem& in = *place.in;
  std::vector<Possible> after;
  for (const Possible& p : place.possible) {
    std::set<TermId> rising;
    for (const ModeGuard& guard : in.guards) {
      if (in.modes[guard.mode] != p.mode) continue;
      const bool rises = guard.IsComparison() && p.rising.contains(guard.formula.terms[0]) &&
                         seen.Acceleration(guard.first).lo > 0;
      if (rises) {
        rising.insert(guard.formula.terms[0]);
      } else if (!seen.IsFalse(guard)) {
        return std::nullopt;
      }
    }
    after.push_back({p.mode, std::move(rising)});
  }
  return after;
}

// What is possible at some time of the step, if `before` is possible when it begins. Nothing if that is too
// much.
std::optional<std::vector<Follower::Possible>> Follower::Reached(const ModeSystem& in, Observation& seen,
                                                                 std::vector<Possible> before) {
  // A possibility, and, if the mode was entered in this step, the comparison that became true then.
  struct Branch {
    Possible now;
    const ModeGuard* by = nullptr;
    bool entered = false;
  };
  std::vector<Branch> branches;
  for (Possible& p : before) {
    // What rises goes on rising in each step during which it accelerates, or is not known to.
    std::erase_if(p.rising, [&](TermId term) {
      return std::ranges::none_of(in.guards, [&](const ModeGuard& g) {
        return g.IsComparison() && g.formula.terms[0] == term && seen.Acceleration(g.first).lo > 0;
      });
    });
    branches.push_back({p, nullptr, false});
  }
  const auto is_strict = [](const ModeGuard& g) { return g.formula.nodes[g.formula.root].strict; };
  for (size_t at = 0; at < branches.size() && branches.size() <= kMostPossible; ++at) {
    for (const ModeGuard& guard : in.guards) {
      const Branch branch = branches[at];
      if (in.modes[guard.mode] != branch.now.mode || seen.IsFalse(guard)) continue;
      Branch next{{guard.after, {}}, nullptr, true};
      if (guard.IsComparison() && IsFinite(seen.Slope(guard.first))) {
        const TermId term = guard.formula.terms[0];
        // Is the term positive, or at least not falling through zero, just after the mode was entered? If the
        // mode was entered in this step by another comparison, that is not known: then the event may follow
        // at once.
        const bool began_false =
            !branch.entered || (branch.by != nullptr && (is_strict(guard) || is_strict(*branch.by)) &&
                                system_.AreOpposite(branch.by->formula.terms[0], term));
        if (began_false) {
          if (seen.Slope(guard.first).lo >= 0 || branch.now.rising.contains(term)) continue;
          next.by = &guard;
        }
        next.now.rising = branch.now.rising;
        next.now.rising.erase(term);
        // It fell to zero. If it goes on falling, ever faster, its negation rises.
        if (began_false && seen.Acceleration(guard.first).hi < 0) {
          for (const ModeGuard& other : in.guards) {
            if (other.IsComparison() && system_.AreOpposite(other.formula.terms[0], term))
              next.now.rising.insert(other.formula.terms[0]);
          }
        }
      }
      const bool known = std::ranges::any_of(
          branches, [&](const Branch& c) { return c.entered && c.now == next.now && c.by == next.by; });
      if (!known) branches.push_back(std::move(next));
    }
  }
  if (branches.size() > kMostPossible) return std::nullopt;
  std::vector<Possible> all;
  for (Branch& c : branches) {
    if (std::ranges::find(all, c.now) == all.end()) all.push_back(std::move(c.now));
  }
  return all;
}

// A step during which events may happen: in all modes that are possible meanwhile at once.
bool Follower::Wander(Place& place, double wanted) {
  std::set<Mode> modes;
  for (const Possible& p : place.possible) modes.insert(p.mode);
  for (size_t round = 0; round < kMostRounds; ++round) {
    const auto made = system_.For({modes.begin(), modes.end()});
    if (!made.ok()) return Fail(made.error().message);
    const ModeSystem& in = *made.value();
    ReachSet from = place.set;
    SetDiscrete(in, from);
    Step step(in.dynamics, order_);
    double taken = wanted;
    if (!Take(step, from, taken)) return false;
    Observation seen(in, step);
    auto reached = Reached(in, seen, place.possible);
    if (!reached) return Fail("too many modes are possible");
    std::vector<Possible> all = std::move(*reached);
    const size_t before = modes.size();
    for (const Possible& p : all) modes.insert(p.mode);
    if (modes.size() > before) continue;
    if (!During(place, in, seen) || !GoOn(place, step, wanted, taken)) return false;
    if (!place.met) {
      // A mode whose event has certainly happened is left by now.
      Image image;
      if (!image.Of(in.observed, place.set, in.dynamics.inputs))
        return Fail("the condition of an event is not defined on the whole set");
      std::erase_if(all, [&](const Possible& p) {
        return std::ranges::any_of(in.guards, [&](const ModeGuard& g) {
          return in.modes[g.mode] == p.mode &&
                 HoldsOn(g, [&](size_t atom) { return image.Range(g.first + atom); });
        });
      });
    }
    if (all.empty()) return Fail("events follow one another without end");
    return Enter(place, std::move(all));
  }
  return Fail("too many events in one step");
}

// Each mode on its own, from here on.
bool Follower::Fork(const Place& place) {
  bool first = true;
  for (const Mode& mode : place.in->modes) {
    if (++forks_ > kMostForks) return Fail("too many modes are possible");
    if (!first) ++next_hint_;  // each begins with a record that says so
    first = false;
    Place branch = place;
    if (!Enter(branch, {{mode, {}}}) || !Follow(std::move(branch))) return false;
  }
  return true;
}

}  // namespace rondo::reach::certify
