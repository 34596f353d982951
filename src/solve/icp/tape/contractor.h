#pragma once

#include <span>
#include <vector>

#include "solve/icp/tape/influence.h"

/// Contraction of boxes by a formula, eight boxes at a time.
namespace rondo::solve::icp {

/// Replaces those lanes of `to` that are in `lanes` by the ones of `from`.
inline void Blend(Lanes lanes, const interval::Batch& from, interval::Batch& to) {
  for (int l = 0; l < interval::kLanes; ++l) {
    if ((lanes >> l & 1) == 0) continue;
    to.nl[l] = from.nl[l];
    to.hi[l] = from.hi[l];
  }
}

/// Runs a tape over eight boxes at once: forward to enclose every number and to see which formulas are still
/// possible, backward to remove what the formula excludes (HC4-revise over the shared graph, Benhamou et al.
/// 1999, with formulas as nodes). Results lane by lane, whatever the other lanes hold.
///
/// Sound for partial functions: an atomic formula about an undefined term is false, so arguments are
/// restricted to domains only where the formula must be true.
class Contractor {
 public:
  Contractor(const Tape& tape, const interval::Kernels& kernels);

  /// Sets one lane. `box` holds the bounds (lower, upper) of each variable in turn.
  void Load(int lane, const double* box);
  /// Reads one lane back, in the same order.
  void Store(int lane, double* box) const;

  /// Contracts all lanes, forward and backward so many times; what is known of the terms in between is kept
  /// from one to the next. Returns those lanes that may still hold a solution.
  Lanes Contract(int sweeps);
  /// Encloses all values and says in which lanes the formula is possible. Contracts nothing.
  Lanes Evaluate();
  /// Tells, after Contract, by threshold, the lanes in which it is undecided; see InfluenceMeter.
  void Open(std::vector<Lanes>& open) const;

  /// Returns enclosures of the nodes, by node.
  const std::vector<interval::Batch>& values() const { return values_; }
  interval::Interval ValueOf(uint32_t node, int lane) const {
    return {-values_[node].nl[lane], values_[node].hi[lane]};
  }

 private:
  struct Comparison {
    Lanes less, equal, greater;  ///< what is possible
  };

  void ForwardNode(uint32_t i);
  void ForwardFormula(uint32_t i);
  void Forward();
  void Backward();
  void BackwardNumber(uint32_t i);
  void RequireThreshold(uint32_t i);
  void RequireChoice(uint32_t i);
  void Compare(uint32_t i);
  Lanes Impossible() const;

  const Tape& tape_;
  const interval::Kernels& k_;
  std::vector<interval::Batch> values_;  ///< by node; formulas leave theirs unused
  std::vector<Lanes> possible_;          ///< formulas: not refuted
  std::vector<Lanes> needed_;  ///< formulas: must be true; numbers: must exist for the formula to be true
  std::vector<Comparison> comparisons_;
  bool again_ = false;  ///< meet new enclosures with those of the sweep before
};

}  // namespace rondo::solve::icp
