#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "expr/numeric.h"
#include "robot/model/world.h"

namespace rondo::sim::motions {

/// Holds the values of everything in a world that can change, in SI units, by position: states, memory, inputs and
/// parameters without a value of all robots, the environment, and the clock of whichever motion is looked at.
class SceneState {
 public:
  explicit SceneState(const robot::World& world);

  const std::vector<expr::TermId>& variables() const { return variables_; }
  /// Returns where the variable is. It must be one.
  size_t Of(expr::TermId variable) const { return places_.at(variable); }
  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }
  double& operator[](expr::TermId variable) { return values_[Of(variable)]; }
  /// Sets the clock that terms read, in seconds.
  void SetClock(double seconds) { values_[clock_] = seconds; }
  /// Returns the values by variable.
  expr::Numeric::Point Point() const;

 private:
  std::vector<expr::TermId> variables_;
  std::unordered_map<expr::TermId, size_t> places_;
  std::vector<double> values_;
  size_t clock_ = 0;
};

}  // namespace rondo::sim::motions
