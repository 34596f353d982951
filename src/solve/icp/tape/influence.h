#pragma once

#include <vector>

#include "interval/batch.h"
#include "interval/interval.h"
#include "solve/icp/tape/tape.h"

/// Which variable to split: how much each can still change.
namespace rondo::solve::icp {

inline constexpr int kLanes = interval::kLanes;
/// Is a set of lanes of a batch, as bits.
using Lanes = uint8_t;

/// Tells how much each variable can change the undecided comparisons of eight boxes: the sum over them of
/// |derivative| * width, each relative to the sum of these over all variables (SmearSumRel, Trombettoni et
/// al. 2011). A heuristic for branching.
class InfluenceMeter {
 public:
  InfluenceMeter(const Tape& tape, const interval::Kernels& kernels);

  /// Computes the scores of all variables: kLanes numbers for each. `values`: enclosures of the nodes.
  /// `open`: by threshold, the lanes in which it is undecided. Cost: one reverse sweep for each open
  /// threshold.
  void Measure(const std::vector<interval::Batch>& values, const std::vector<Lanes>& open,
               std::vector<double>& scores);

  /// Encloses the derivatives of a compared number by each variable, over the box in lane 0. False where it
  /// may not be differentiable.
  bool Gradient(uint32_t node, const std::vector<interval::Batch>& values,
                std::vector<interval::Interval>& gradient);

 private:
  // A number that is compared, and what it depends on, latest node first.
  struct Cone {
    uint32_t root = 0;
    std::vector<size_t> thresholds;
    std::vector<uint32_t> nodes;
    std::vector<uint32_t> variables;
  };

  void Derive(const Cone& cone, const std::vector<interval::Batch>& values);
  void Pass(const Node& node, uint32_t id, const std::vector<interval::Batch>& values);
  const interval::Batch& Slope(const Node& node, uint32_t id, const std::vector<interval::Batch>& values);

  const Tape& tape_;
  const interval::Kernels& k_;
  std::vector<Cone> cones_;
  std::vector<interval::Batch> adjoints_;
  std::vector<interval::Batch> slopes_;
  std::vector<uint64_t> known_;  // in which round the slope was computed
  uint64_t round_ = 0;
  std::vector<double> parts_;
};

}  // namespace rondo::solve::icp
