#include "reach/certify/models/image.h"

#include "reach/certify/models/straight.h"
#include "reach/certify/models/upward.h"

namespace rondo::reach::certify {

// Each open kink in turn is enclosed on what the set shows of its argument, those before it being sums by then.
bool Image::OfStraight(Program program, uint32_t open, const OnBox& on, const ReachSet& set,
                       const interval::Box& inputs) {
  for (; open < program.code.size(); open = OpenKink(program, on, open + 1)) {
    Image argument;
    if (!argument.Of(ArgumentOf(program, open), set, inputs)) return false;
    const Interval range = argument.Range(0);
    if (!IsFinite(range)) return false;
    Straighten(program, open, range);
  }
  return Of(program, set, inputs);
}

bool Image::Of(const Program& program, const ReachSet& set, const interval::Box& inputs) {
  const size_t n = set.states();
  const size_t width = program.variables.size();
  const size_t count = program.outputs.size();
  const auto at = [](size_t i) { return static_cast<Eigen::Index>(i); };
  basis_ = set.basis;
  interval::Box box = set.Box();
  box.insert(box.end(), inputs.begin(), inputs.end());
  OnBox on;
  if (!Linearise(program, box, count, on)) return false;
  if (const uint32_t open = OpenKink(program, on, 0); open < program.code.size())
    return OfStraight(program, open, on, set, inputs);
  const Algebra algebra(*basis_, 0);
  std::vector<Model> variables;
  for (const std::vector<double>& p : set.polynomials) variables.push_back(algebra.InSymbols(p));
  for (const Interval input : inputs) variables.push_back(algebra.Constant(input));
  const auto models = Evaluate(program, algebra, variables, on);
  if (!models) return false;
  const Nearby nearby{RangesOf(algebra, *models), set.Errors()};
  if (!Linearise(program, box, count, on, &nearby)) return false;
  // f(p + e) - f(p) = J e: the middle of J carries the errors, its radius makes new ones.
  Eigen::MatrixXd centre(at(count), at(n));
  errors_.resize(at(count));
  outputs_.clear();
  boxes_.clear();
  const Eigen::VectorXd& size = nearby.errors;
  for (size_t i = 0; i < count; ++i) {
    outputs_.push_back((*models)[program.outputs[i]]);
    boxes_.push_back(on.values[program.outputs[i]]);
    double more = outputs_[i].error;
    double rounded = 0;
    for (size_t j = 0; j < n; ++j) {
      const Interval slope = on.slopes[i * width + j];
      centre(at(i), at(j)) = slope.Middle();
      more += Radius(slope) * size[at(j)];
      rounded += std::fabs(slope.Middle()) * size[at(j)];
    }
    errors_[at(i)] = more == 0 && rounded == 0 ? 0 : Up(more + Gamma(static_cast<double>(n) + 2) * rounded);
  }
  generators_ = centre * set.generators;
  return generators_.allFinite() && errors_.allFinite();
}

Interval Image::Range(size_t output) const {
  const auto row = static_cast<Eigen::Index>(output);
  const double error = Up(generators_.row(row).cwiseAbs().sum() + errors_[row]);
  Model model = outputs_[output];
  model.error = error;  // its own is among `errors_`
  const Algebra algebra(*basis_, 0);
  return interval::Meet(algebra.Range(model, 0, 0), boxes_[output]);
}

ReachSet Image::Set() const {
  ReachSet set;
  set.basis = basis_;
  for (const Model& m : outputs_) set.polynomials.push_back(m.polynomial);
  set.generators = generators_;
  set.AddErrors(errors_);
  return set;
}

}  // namespace rondo::reach::certify
