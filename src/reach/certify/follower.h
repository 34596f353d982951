#pragma once

#include "base/stop.h"
#include "reach/certify/checker.h"
#include "reach/certify/image.h"
#include "reach/certify/system.h"

namespace rondo::reach::certify {

/// Follows one part of the initial set as its record says, and shows every claim on the way.
class Follower {
 public:
  Follower(const System& system, Bases& bases, const base::StopToken& stop)
      : system_(system), bases_(bases), stop_(stop) {}

  /// Why the claims are not shown; empty if they are.
  std::string Run(const interval::Box& part, const std::vector<PartRecord::Step>& steps);
  size_t steps() const { return steps_; }
  /// After a failure: the side of the part whose halves should be looked at, each on its own, if there is
  /// one.
  std::optional<size_t> WorstSide() const;

 private:
  void Begin(const interval::Box& box);
  bool Control();
  bool Segment(const Rational& from, const Rational& to);
  bool StepOn(double wanted, const Rational& from, const Rational& to, double& taken);
  bool AtInstant(const Rational& instant, bool start);
  bool During(const Step& step, const Rational& from, const Rational& to);
  void Fall(const Step& step);
  bool StaysBelow(const Step& step, size_t output, const OnBox& on) const;
  bool Fail(std::string reason);

  const System& system_;
  Bases& bases_;
  const base::StopToken& stop_;
  const std::vector<PartRecord::Step>* hints_ = nullptr;
  std::vector<std::optional<size_t>> symbol_;  ///< by state
  size_t next_hint_ = 0;
  size_t symbols_ = 0;
  size_t order_ = 0;
  ReachSet set_;
  std::vector<std::vector<bool>> falls_;  ///< by claim and term: at most zero since the start?
  double time_ = 0;                       ///< roughly, for messages
  size_t steps_ = 0;
  interval::Box last_rates_;  ///< of the last step
  std::string reason_;
};

}  // namespace rondo::reach::certify
