#pragma once

#include <optional>
#include <random>
#include <vector>

#include "solve/icp/tape/tape.h"

/// Guesses of solutions, by descent in plain floating point.
namespace rondo::solve::icp {

/// Looks for points at which a formula seems to hold: from random points of a box, steps that would mend all
/// violated comparisons if they were linear (Gauss-Newton, the smallest such step). Plain floating point:
/// whatever is found must be verified. Deterministic.
class Descent {
 public:
  /// `box`: bounds (lower, upper) of each variable in turn, in which points are drawn.
  Descent(const Tape& tape, const std::vector<double>& box);

  /// Makes one attempt. Returns a number for each variable; nothing if it led nowhere.
  std::optional<std::vector<double>> Try();

 private:
  /// Is a comparison whose number should change by `by`.
  struct Violation {
    uint32_t node;
    double by;  ///< how much the number is to grow
    bool equation;
  };

  void Evaluate();
  double Value(const Node& node) const;
  double Collect(uint32_t formula, std::vector<Violation>& out) const;
  bool Step(const std::vector<Violation>& violations);
  void Differentiate(uint32_t node);
  void Pass(const Node& node, uint32_t id);

  const Tape& tape_;
  std::vector<double> box_;
  std::vector<double> point_;
  std::vector<double> values_;
  std::vector<double> adjoints_;
  std::mt19937_64 rng_{1};
};

}  // namespace rondo::solve::icp
