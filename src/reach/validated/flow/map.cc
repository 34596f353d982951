#include "reach/validated/flow/map.h"

#include <algorithm>
#include <cmath>

#include "reach/validated/flow/kinks.h"
#include "reach/validated/series/bound.h"

namespace rondo::reach {

Map::Map(const Program& program, size_t states, std::vector<Interval> inputs,
         std::shared_ptr<Monomials> monomials)
    : program_(program),
      states_(states),
      inputs_(std::move(inputs)),
      monomials_(std::move(monomials)),
      models_(program, monomials_, 1),
      box_(program, 1),
      branches_(program.code.size(), Branch::kEither),
      held_(program.code.size()),
      error_(static_cast<Eigen::Index>(states)),
      more_(program.outputs.size()) {}

// Without maxima and absolute values that are open, each enclosed on what the set itself shows of its argument.
bool Map::Replace(const FlowSet& set) {
  replaced_ = program_;
  for (uint32_t n = 0; n < program_.code.size(); ++n) {
    const CodeOp op = program_.code[n].op;
    if (branches_[n] != Branch::kEither || (op != CodeOp::kMax && op != CodeOp::kAbs)) continue;
    const Program compared = ComparedAt(replaced_, n);
    Map before(compared, states_, inputs_, monomials_);
    if (!before.Apply(set)) return false;
    const Interval range = before.Range(0);
    if (!std::isfinite(range.lo) || !std::isfinite(range.hi)) return false;
    ReplaceKink(replaced_, n, range);
  }
  replacement_ = std::make_unique<Map>(replaced_, states_, inputs_, monomials_);
  return replacement_->Apply(set);
}

bool Map::Apply(const FlowSet& set) {
  const auto rows = static_cast<Eigen::Index>(program_.outputs.size());
  const auto columns = static_cast<Eigen::Index>(states_);
  for (size_t i = 0; i < states_; ++i) {
    const double error = set.Error(i);
    error_[static_cast<Eigen::Index>(i)] = error;
    box_.SetVariable(i, 0, RangeOf(*monomials_, set.Polynomial(i)) + Interval{-error, error});
  }
  for (size_t w = 0; w < inputs_.size(); ++w) box_.SetVariable(states_ + w, 0, inputs_[w]);
  replacement_ = nullptr;
  if (!box_.Decide(branches_, held_)) return false;
  const bool open = std::ranges::any_of(program_.kinks, [&](uint32_t n) {
    return branches_[n] == Branch::kEither && program_.code[n].op != CodeOp::kChoose;
  });
  if (open) return Replace(set);
  models_.Begin(set.degree, 0);
  for (size_t i = 0; i < states_; ++i) models_.SetVariable(i, 0, set.Polynomial(i), 0);
  for (size_t w = 0; w < inputs_.size(); ++w) {
    const double middle = inputs_[w].Middle();
    models_.SetVariable(states_ + w, 0, std::span(&middle, 1), 0);
  }
  if (!models_.Compute(0, branches_, held_)) return false;
  box_.Gradient(program_.outputs, branches_, {}, true, gradient_);
  const size_t width = program_.variables.size();
  centre_.resize(rows, columns);
  radius_.resize(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto row = static_cast<size_t>(i) * width;
    double more = models_.At(program_.outputs[static_cast<size_t>(i)], 0).radius;
    for (Eigen::Index j = 0; j < columns; ++j) {
      const Interval d = gradient_[row + static_cast<size_t>(j)];
      if (!std::isfinite(d.lo) || !std::isfinite(d.hi)) return false;
      centre_(i, j) = d.Middle();
      radius_(i, j) = d.IsPoint() ? 0 : Above(std::fmax(d.hi - centre_(i, j), centre_(i, j) - d.lo));
      more += radius_(i, j) * error_[j];
    }
    for (size_t w = 0; w < inputs_.size(); ++w)
      more += Magnitude(gradient_[row + states_ + w]) * Above(inputs_[w].Width() * 0.5);
    more_[static_cast<size_t>(i)] = Above(more);
    if (!std::isfinite(more)) return false;
  }
  // The linear images of the errors, one column each.
  const auto n = static_cast<Eigen::Index>(states_);
  images_.resize(rows, set.used + n);
  images_.leftCols(set.used) = centre_ * set.generators.leftCols(set.used);
  for (Eigen::Index i = 0; i < n; ++i)
    images_.col(set.used + i) = centre_.col(i) * set.slack[static_cast<size_t>(i)];
  return true;
}

Interval Map::Range(size_t output) const {
  if (replacement_) return interval::Meet(replacement_->Range(output), box_.Of(program_.outputs[output], 0));
  const auto row = static_cast<Eigen::Index>(output);
  double sum = images_.row(row).cwiseAbs().sum() + more_[output];
  sum += centre_.row(row).cwiseAbs().dot(error_) * Roundings(static_cast<double>(states_) + 2);
  // The model's radius is in more_ already.
  const auto model = models_.At(program_.outputs[output], 0);
  const double error = Above(sum);
  return interval::Meet(RangeOf(*monomials_, model.polynomial) + Interval{-error, error},
                        box_.Of(program_.outputs[output], 0));
}

void Map::Finish(const FlowSet& set, FlowSet& next, Eigen::Index capacity) const {
  if (replacement_) return replacement_->Finish(set, next, capacity);
  next.dimension = set.dimension;
  next.degree = set.degree;
  next.count = set.count;
  next.polynomials.resize(set.dimension * set.count);
  for (size_t i = 0; i < set.dimension; ++i) {
    const auto model = models_.At(program_.outputs[i], 0);
    std::copy(model.polynomial.begin(), model.polynomial.end(), next.Polynomial(i).begin());
  }
  next.generators = set.generators;
  next.used = set.used;
  next.slack = set.slack;
  next.Transform(centre_, more_, capacity);
}

}  // namespace rondo::reach
