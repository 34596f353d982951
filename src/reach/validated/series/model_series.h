#pragma once

#include <memory>
#include <vector>

#include "reach/problem/program.h"
#include "reach/validated/series/convolve.h"
#include "reach/validated/series/monomials.h"

/// Taylor series in time whose coefficients are Taylor models in the initial state.
namespace rondo::reach {

/// Says what to take for the nodes without derivatives, by node.
enum class Branch : int8_t {
  kFirst,   ///< of kAbs: the argument itself; of kChoose: the first value
  kSecond,  ///< of kAbs: its negation; of kChoose: the other value
  kEither,  ///< not known: a map takes whatever the value can be, a flow the value in `held`
};

/// Is a Taylor model: the set of all p(s) + e, s in [-1, 1]^m, |e| <= radius, where p is a polynomial.
struct ModelView {
  std::span<const double> polynomial;
  double radius;
};

/// Computes the Taylor coefficients in time of every node of a program, as Taylor models in the symbols s:
/// coefficient k of node v encloses, for each s, the k-th Taylor coefficient of v along the solution that
/// starts at the model of the initial state at s. Coefficients of order k may depend on the variables'
/// coefficients up to order k only, so that a caller can fill in those of a differential equation one after
/// the other.
///
/// Rigorous: truncation of degrees and all rounding (docs/theory.md, "Reachability") go to the radii.
/// @source Makino & Berz, Taylor models and other validated functional inclusion methods (2003).
class ModelSeries {
 public:
  ModelSeries(const Program& program, std::shared_ptr<Monomials> monomials, size_t orders);

  /// Forgets everything; polynomials of this degree from now on, orders 0 to `last`.
  void Begin(size_t degree, size_t last);

  size_t count() const { return count_; }  ///< of monomials
  size_t degree() const { return degree_; }
  /// Sets a coefficient of a variable, as a model.
  void SetVariable(size_t variable, size_t order, std::span<const double> polynomial, double radius);
  /// Sets a variable's coefficient of order + 1: its derivative's (output `output`) of this order, divided by
  /// order + 1.
  void SetFromDerivative(size_t variable, size_t output, size_t order);
  /// Computes the nodes from `first` to before `end` at this order. Returns false if some function is not
  /// defined on all of its argument.
  bool Compute(size_t order, const std::vector<Branch>& branches, const std::vector<Interval>& held,
               uint32_t first, uint32_t end);
  bool Compute(size_t order, const std::vector<Branch>& branches, const std::vector<Interval>& held) {
    return Compute(order, branches, held, 0, static_cast<uint32_t>(program_.code.size()));
  }

  /// Returns the coefficient of a node, valid until the next `Begin`.
  ModelView At(size_t node, size_t order) const {
    return {std::span(values_).subspan(Place(node, order), count_), radius_[node * orders_ + order]};
  }
  /// Encloses the model.
  Interval Range(size_t node, size_t order) const;
  Interval RangeOf(ModelView model) const;

 private:
  // Operands of Convolve: one of them forward in order, the other backward.
  struct Operand {
    enum class Weight : uint8_t { kOne, kOrder, kNotFirst };
    uint32_t node = 0;
    bool backward = false;
    Weight weight = Weight::kOne;
    std::vector<double> packed;
  };
  struct Sum {
    uint32_t left, right;
  };
  struct Node {
    std::vector<uint32_t> packed_as;  ///< operands
    Sum sums[3] = {};
  };
  struct Model {
    std::vector<double> polynomial;
    double radius = 0;
  };

  size_t Place(size_t node, size_t order) const { return (node * orders_ + order) * count_; }
  double* Values(size_t node, size_t order) { return values_.data() + Place(node, order); }
  double& Radius(size_t node, size_t order) { return radius_[node * orders_ + order]; }
  double* Norms(size_t node, size_t order) {
    return norms_.data() + (node * orders_ + order) * (degree_ + 1);
  }
  const double* Norms(size_t node, size_t order) const {
    return norms_.data() + (node * orders_ + order) * (degree_ + 1);
  }
  double Norm(size_t node, size_t order) const;
  uint32_t Need(uint32_t node, bool backward, Operand::Weight weight);
  // sum over a of left_a * right_(order - a) to `out`; the returned radius holds all errors.
  double Convolution(const Sum& sum, size_t order, double* out);
  double Truncation(const double* left, const double* right) const;
  void Finish(size_t node, size_t order);
  bool Function(CodeOp function, size_t argument, Model& out) const;
  bool Compose(CodeOp function, Model argument, Model& out) const;
  bool Arctangent2(size_t y, size_t x, double* out, double& radius);
  void Multiply(const Model& a, const Model& b, Model& out) const;
  void MultiplyInto(const double* a, double a_radius, const Model& b, double* out, double& radius) const;
  void LinearNode(size_t node, size_t order);
  void KinkNode(size_t node, size_t order, Branch branch, Interval held);
  void Scale(size_t node, size_t order, double factor, double error);
  double Subtracted(size_t from, size_t order, double factor, double error);
  void Divide(size_t node, size_t order, double error);
  bool Assign(size_t node, CodeOp function, uint32_t argument);
  bool Invert(size_t node, uint32_t argument);
  bool FunctionNode(uint32_t n);
  void Arctangent2Order(uint32_t n, size_t order, double share);
  void FunctionOrder(uint32_t n, size_t order);
  Interval RangeOfParts(std::span<const double> polynomial, double radius) const;

  const Program& program_;
  std::shared_ptr<Monomials> monomials_;
  Convolve convolve_ = BestConvolve();
  size_t orders_, stride_;
  size_t degree_ = 0, count_ = 0, last_ = 0;
  std::vector<double> values_, norms_, radius_;
  std::vector<Operand> operands_;
  std::vector<Node> nodes_;
  std::vector<Model> inverses_;  ///< of nodes that divide by an order 0
  std::vector<double> scratch_;
};

}  // namespace rondo::reach
