#pragma once

#include <algorithm>
#include <set>

#include "reach/validated/flow/map.h"
#include "reach/validated/flow/stage.h"
#include "reach/validated/prover.h"
#include "verdict/truth.h"
#include "verdict/verdict.h"

/// One part of the initial set, followed by the engine from the start to the horizon.
namespace rondo::reach {

/// Tells what came of one part of the initial set.
struct Attempt {
  bool proved = false;
  bool vacuous = false;  ///< nothing in the part satisfies what is assumed
  Leaf leaf;
  std::string reason;  ///< why not, if it is not proved
  verdict::Shortfall shortfall = verdict::Shortfall::kMethod;
  double time = 0;            ///< at which it failed, in seconds
  size_t claim = 0;           ///< which could not be shown, if it was a claim
  size_t split = 0;           ///< the state whose side should be halved
  std::vector<double> worst;  ///< a start that seemed worst
};

/// Follows one part of the initial set through all that can happen to it.
///
/// Between events, in one mode, the set follows the flow. An event that the whole set meets transversally is
/// met at a time that is a polynomial of the initial state (Cross). Else the modes before and after are
/// possible at once (Window), until it is certain what has happened.
class Runner {
 public:
  Runner(Stages& stages, const ProverOptions& options, const FlowOptions& flow, const interval::Box& box,
         const interval::Box& whole, const base::StopToken& stop);

  /// Proves the claims for this part, or says why that failed.
  Attempt Run();
  /// Reports, instead of proving, whether the claim certainly fails at this time (seconds) for all of the
  /// set.
  bool Breaks(size_t claim, double time);
  /// Encloses, instead of proving, what the queries can be; nothing if the set cannot be followed.
  std::optional<std::vector<Interval>> Ask(const std::vector<Query>& queries);

 private:
  /// A mode that is possible, and what is known of the terms of its events.
  struct Possible {
    Mode mode;
    std::set<TermId> rising;  ///< terms that do not fall any more while their second derivative is positive
    bool operator==(const Possible&) const = default;
  };
  // How far a set has come.
  struct State {
    FlowSet set;
    double time = 0;
    double step = 0;  ///< the length of the next one
    std::vector<Possible> possible;
    size_t sample = 0;    ///< of the controller, the next one
    size_t halvings = 0;  ///< of a symbol, at events
    size_t rounds = 0;    ///< of events at this instant
    bool look = true;     ///< whether to look for events at this instant
    bool begun = false;   ///< whether the claims have been looked at at the start
  };
  enum class Next : uint8_t { kFailed, kChanged, kFork, kNo, kDone };

  bool IsCopy(size_t i) const;
  void MakeSymbols();
  State Begin() const;
  bool Fail(double time, std::string reason, verdict::Shortfall shortfall = verdict::Shortfall::kMethod);
  bool Stopped(double time);
  bool NotEstablished(double time, size_t claim);

  bool Follow(State state);
  bool Fork(const State& state);
  Next Along(State& state, const Stage& stage);
  Next StepOn(Flow& flow, State& state, const Stage& stage, double until);
  void SetDiscrete(const Stage& stage, FlowSet& set) const;
  FlowOptions OptionsFor(double first_step) const;
  std::vector<Mode> ModesOf(const State& state) const;
  void Keep(const Stage& stage, double from, double to, const interval::Box& during);
  bool TooWide(const Flow& flow, double share = 2) const;

  // Claims.
  void Fall(const Stage& stage, Stepper& stepper);
  bool Instants(const Stage& stage, const FlowSet& set, Map& observe, double time, bool start);
  bool During(Flow& flow, const Stage& stage, double from, double to);
  void Answer(Flow& flow, const Stage& stage, double from, double to);
  static Interval AtMostZero(Interval range) { return {std::min(range.lo, 0.0), std::min(range.hi, 0.0)}; }

  // Events.
  bool Quiet(Flow& flow, const Stage& stage, State& state) const;
  verdict::Truth During(const Guard& guard, Flow& flow) const;
  bool Happened(State& state, const Stage& stage, Map& observe);
  Next Window(const Flow& before, State& state, double until);
  bool Successors(const Stage& stage, Flow& flow, std::vector<Possible>& all) const;
  Next Meet(const Flow& flow, State& state, const Stage& stage, double until);
  Next Cross(State& state, const Stage& stage, double until, std::optional<size_t>& symbol);
  Next SplitAt(const State& state, size_t symbol);
  class Crossing;

  void ChooseSplit(const FlowSet& set);

  Stages& stages_;
  const ProverOptions& options_;
  const FlowOptions& flow_;
  const interval::Box& box_;
  const interval::Box& whole_;
  const base::StopToken& stop_;
  double horizon_;
  bool claims_ = true;            ///< whether they are to be looked at
  std::optional<size_t> broken_;  ///< else: the one that should fail at the horizon
  const std::vector<Query>* queries_ = nullptr;
  std::vector<Interval> answers_;
  std::vector<int> symbol_of_;
  /// By claim of the stage and term: whether it has stayed below zero since the start.
  std::vector<std::vector<bool>> falls_;
  std::shared_ptr<Monomials> monomials_;
  Attempt attempt_;
  std::optional<State> earlier_;  ///< where the step before began
  FlowSet last_;                  ///< where it stopped
  size_t forks_ = 0;
  size_t splits_ = 0;
};

}  // namespace rondo::reach
