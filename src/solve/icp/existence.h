#pragma once

#include <optional>

#include "solve/icp/tape/contractor.h"

/// Proofs that equations have solutions, where no exact solution can be written down.
namespace rondo::solve::icp {

/// Proves that the equations of a formula have a common solution near a point, by Krawczyk's operator: as
/// many variables as there are equations move in a small box, the others stay. Rigorous: interval
/// derivatives, rounding included (Neumaier 1990, theorem 5.1.8).
class Existence {
 public:
  Existence(const Tape& tape, const interval::Kernels& kernels);

  /// Returns how many equations the formula demands.
  size_t equations() const { return equations_.size(); }
  /// Returns bounds of the variables (lower, upper, in turn) between which all equations that the formula
  /// demands hold somewhere; those that stay are points. nullopt: none are demanded, or nothing could be
  /// shown.
  std::optional<std::vector<double>> Around(const std::vector<double>& point);

 private:
  bool Linearise(const std::vector<double>& box);
  std::optional<std::vector<double>> Prove(const std::vector<double>& point, double radius);

  const Tape& tape_;
  const interval::Kernels& kernels_;
  std::optional<Contractor> contractor_;  // made when they are needed
  std::optional<InfluenceMeter> meter_;
  std::vector<uint32_t> equations_;                      // thresholds
  std::vector<interval::Interval> residuals_;            // of the equations, over the last box
  std::vector<std::vector<interval::Interval>> slopes_;  // by equation and variable
};

}  // namespace rondo::solve::icp
