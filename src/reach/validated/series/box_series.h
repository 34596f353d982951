#pragma once

#include <vector>

#include "reach/validated/series/model_series.h"

/// Taylor coefficients on boxes: they bound the rest of the series that models compute.
namespace rondo::reach {

/// Computes Taylor coefficients in time and first derivatives of every node of a program over a box, in
/// interval arithmetic.
class BoxSeries {
 public:
  BoxSeries(const Program& program, size_t orders);

  /// Sets a coefficient of a variable.
  void SetVariable(size_t variable, size_t order, Interval value) {
    At(program_.variable_nodes[variable], order) = value;
  }
  /// Sets a variable's coefficient of order + 1: its derivative's (output `output`) of this order, divided by
  /// order + 1.
  void SetFromDerivative(size_t variable, size_t output, size_t order);
  /// Computes the nodes from `first` to before `end` at this order. Returns false if some function is not
  /// defined on all of its argument. A node without derivative whose branch is kEither is constant in time:
  /// `held`, or if `map`, all that it can be.
  bool Compute(size_t order, const std::vector<Branch>& branches, const std::vector<Interval>& held,
               bool map = false, uint32_t first = 0, uint32_t end = UINT32_MAX);
  /// Returns the enclosure of a node's coefficient of this order.
  Interval Of(size_t node, size_t order) const { return values_[node * orders_ + order]; }

  /// Computes order 0 of everything, where nodes without derivative decide for themselves which branch they
  /// take, and `held` becomes all that the others can be. Returns false as Compute does.
  bool Decide(std::vector<Branch>& branches, std::vector<Interval>& held);

  /// Returns which branch a node without derivative takes on all of the box, from order 0.
  Branch BranchOf(size_t node) const;
  /// Encloses everything that such a node can be on the box.
  Interval HullOf(size_t node) const;

  /// Encloses the derivatives of the outputs by the variables and then by the nodes in `sources` (kinks that
  /// are held), over the box of order 0; rows of nodes before `first` are known from an earlier call: out[row
  /// * (variables + sources) + column].
  void Gradient(const std::vector<uint32_t>& outputs, const std::vector<Branch>& branches,
                const std::vector<uint32_t>& sources, bool map, std::vector<Interval>& out,
                uint32_t first = 0, uint32_t end = UINT32_MAX);

 private:
  Interval& At(size_t node, size_t order) { return values_[node * orders_ + order]; }
  bool First(uint32_t node, const std::vector<Branch>& branches, const std::vector<Interval>& held, bool map);
  void Later(uint32_t node, size_t order, const std::vector<Branch>& branches);
  // d node / d argument, for functions of one variable
  Interval Slope(uint32_t node) const;

  const Program& program_;
  size_t orders_;
  std::vector<Interval> values_;
  std::vector<std::vector<uint32_t>> columns_;  ///< of the gradient, by node, for `sources_`
  std::vector<uint32_t> sources_;
  std::vector<std::vector<Interval>> rows_;
};

}  // namespace rondo::reach
