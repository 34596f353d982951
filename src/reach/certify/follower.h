#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/stop.h"
#include "reach/certify/checker.h"
#include "reach/certify/models/image.h"
#include "reach/certify/observation.h"
#include "reach/certify/system.h"

/// One part of the initial set, followed by the checker from the start to the horizon.
namespace rondo::reach::certify {

/// Follows one part of the initial set as its record says, and shows every claim on the way.
class Follower {
 public:
  /// @param most_degree  of polynomials in the start, whatever the record says.
  Follower(System& system, Bases& bases, size_t most_degree, const base::StopToken& stop)
      : system_(system), bases_(bases), most_degree_(most_degree), stop_(stop) {}

  /// Returns why the claims are not shown for all of the part; nothing (an empty text) if they are.
  ///
  /// @param recorded  the part that the steps were recorded for: this one, or a larger one.
  std::string Run(const interval::Box& part, const interval::Box& recorded,
                  const std::vector<PartRecord::Step>& steps);
  /// Encloses, after a success, the states at the horizon. Empty if nothing in the part satisfies what is
  /// assumed.
  const interval::Box& End() const { return end_; }
  /// Returns how many steps of the flow were shown.
  size_t steps() const { return steps_; }
  /// Returns, after a failure, the side of the part whose halves should be looked at, each on its own, if
  /// there is one: that of the symbol on which the last set depends most, terms that are not linear above
  /// all.
  std::optional<size_t> WorstSide() const;

 private:
  // A mode that is possible, and terms of its events that certainly rise now, if the mode still lasts: their
  // first derivative is not negative.
  struct Possible {
    Mode mode;
    std::set<TermId> rising;
    bool operator==(const Possible&) const = default;
  };
  // What a symbol of the record is in terms of ours: offset + scale * symbol.
  struct Scale {
    double offset = 0, scale = 1;
  };
  // How far a set has come.
  struct Place {
    ReachSet set;
    std::vector<Possible> possible;
    std::shared_ptr<const ModeSystem> in;  ///< their modes
    size_t instant = 0;                    ///< the last one that was met
    Interval left;                         ///< seconds to the next one
    bool met = true;                       ///< whether that is just now
    double carried = 0;                    ///< what is left of a step that was too long
    bool open = false;                     ///< whether events may happen in what is left of it
    /// By claim and term: whether it was at most zero ever since the start.
    std::vector<std::vector<bool>> falls;
    std::vector<Scale> recorded;  ///< by symbol of the record: what it is in terms of ours
  };

  Place Begin(const interval::Box& box, const interval::Box& recorded);
  bool Enter(Place& place, std::vector<Possible> possible);
  static void SetDiscrete(const ModeSystem& in, ReachSet& set);
  bool Follow(Place place);
  bool Meet(Place& place);
  bool Settle(Place& place);
  bool Advance(Place& place, const PartRecord::Step* hint);
  bool TakeStep(Place& place, double wanted);
  bool Take(Step& step, const ReachSet& from, double& taken);
  bool GoOn(Place& place, const Step& step, double wanted, double taken);
  bool Split(const Place& place, size_t symbol);
  bool AtInstant(const Place& place, bool start);

  static std::optional<std::vector<Possible>> Quiet(const Place& place, Observation& seen);
  bool Wander(Place& place, double wanted);
  bool Fork(const Place& place);
  std::optional<std::vector<Possible>> Reached(const ModeSystem& in, Observation& seen,
                                               std::vector<Possible> before);
  bool Fail(std::string reason);

  bool IsDue(const Place& place, const ModeClaim& claim) const;
  bool During(const Place& place, const ModeSystem& in, Observation& seen);

  bool Cross(Place& place, const PartRecord::Step& record);
  void AddTime(const Place& place, const std::vector<uint32_t>& exponents, double factor,
               std::vector<double>& time) const;
  // An event that is met: which of its terms decides, and how fast that falls, as has been seen so far.
  struct Event {
    std::shared_ptr<const ModeSystem> before;
    const ModeGuard* guard;  ///< one of its
    std::optional<size_t> term = std::nullopt;
    double slope = HUGE_VAL;
  };
  bool Move(Place& place, const Pace& whole, Event& event);
  bool Switch(Place& place, const Event& event);
  bool HoldsAround(const Place& place, const ModeSystem& in, const ReachSet& set, const Event& event);
  bool Returns(const Event& event, const ModeGuard& guard);

  static constexpr size_t kMostRounds = 32;  ///< of events at one instant, or in one step
  static constexpr size_t kMostPossible = 64;

  System& system_;
  Bases& bases_;
  size_t most_degree_;
  const base::StopToken& stop_;
  const std::vector<PartRecord::Step>* hints_ = nullptr;
  bool wanders_ = false;  ///< whether there is a step among them during which several modes are possible
  std::vector<std::optional<size_t>> symbol_;  ///< by state: its symbol, if it has one
  size_t next_hint_ = 0;
  size_t symbols_ = 0;
  size_t order_ = 0;
  ReachSet last_;  ///< where it stopped, for WorstSide
  interval::Box end_;
  double time_ = 0;  ///< how far it is, in seconds: roughly, for messages
  size_t steps_ = 0;
  size_t splits_ = 0;
  size_t forks_ = 0;
  std::string reason_;
};

}  // namespace rondo::reach::certify
