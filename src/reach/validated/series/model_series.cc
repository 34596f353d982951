#include "reach/validated/series/model_series.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "reach/validated/series/bound.h"
#include "reach/validated/series/jet.h"

namespace rondo::reach {

ModelSeries::ModelSeries(const Program& program, std::shared_ptr<Monomials> monomials, size_t orders)
    : program_(program), monomials_(std::move(monomials)), orders_(orders) {
  // A row of an operand: the orders, rounded up to whole vectors, and one vector to read beyond.
  stride_ = (orders_ + kWidth - 1) / kWidth * kWidth;
  nodes_.resize(program.code.size());
  inverses_.resize(program.code.size());
  using Weight = Operand::Weight;
  for (uint32_t n = 0; n < program.code.size(); ++n) {
    const Code& c = program.code[n];
    Node& node = nodes_[n];
    switch (c.op) {
      case CodeOp::kProduct:
        node.sums[0] = {Need(c.a, false, Weight::kOne), Need(c.b, true, Weight::kOne)};
        break;
      case CodeOp::kReciprocal:
        node.sums[0] = {Need(c.a, false, Weight::kNotFirst), Need(n, true, Weight::kOne)};
        break;
      case CodeOp::kRoot:
        node.sums[0] = {Need(n, false, Weight::kNotFirst), Need(n, true, Weight::kOne)};
        break;
      case CodeOp::kSine:
        node.sums[0] = {Need(c.a, false, Weight::kOrder), Need(n + 1, true, Weight::kOne)};
        break;
      case CodeOp::kCosine:
        node.sums[0] = {Need(c.a, false, Weight::kOrder), Need(n - 1, true, Weight::kOne)};
        break;
      case CodeOp::kExp:
        node.sums[0] = {Need(c.a, false, Weight::kOrder), Need(n, true, Weight::kOne)};
        break;
      case CodeOp::kLog:
        node.sums[0] = {Need(n, false, Weight::kOrder), Need(c.a, true, Weight::kOne)};
        break;
      case CodeOp::kAtan:
        node.sums[0] = {Need(n, false, Weight::kOrder), Need(c.b, true, Weight::kOne)};
        break;
      case CodeOp::kAtan2:
        node.sums[0] = {Need(n, false, Weight::kOrder), Need(c.c, true, Weight::kOne)};
        node.sums[1] = {Need(c.a, false, Weight::kOrder), Need(c.b, true, Weight::kOne)};
        node.sums[2] = {Need(c.b, false, Weight::kOrder), Need(c.a, true, Weight::kOne)};
        break;
      case CodeOp::kVariable:
      case CodeOp::kLinear:
      case CodeOp::kAbs:
      case CodeOp::kMax:
      case CodeOp::kChoose:
        break;
    }
  }
}

uint32_t ModelSeries::Need(uint32_t node, bool backward, Operand::Weight weight) {
  for (const uint32_t o : nodes_[node].packed_as) {
    if (operands_[o].backward == backward && operands_[o].weight == weight) return o;
  }
  Operand operand;
  operand.node = node;
  operand.backward = backward;
  operand.weight = weight;
  operands_.push_back(std::move(operand));
  const auto id = static_cast<uint32_t>(operands_.size() - 1);
  nodes_[node].packed_as.push_back(id);
  return id;
}

void ModelSeries::Begin(size_t degree, size_t last) {
  CHECK(last < orders_);
  last_ = last;
  if (degree != degree_ || count_ == 0) {
    monomials_->Extend(degree);
    degree_ = degree;
    count_ = monomials_->Count(degree);
    values_.assign(program_.code.size() * orders_ * count_, 0);
    norms_.assign(program_.code.size() * orders_ * (degree_ + 1), 0);
    radius_.assign(program_.code.size() * orders_, 0);
    for (Operand& o : operands_) o.packed.assign(count_ * stride_ + kWidth, 0);
    scratch_.resize(count_);
    return;
  }
  // What is not computed yet counts as zero.
  for (Operand& o : operands_) std::fill(o.packed.begin(), o.packed.end(), 0.0);
  std::fill(norms_.begin(), norms_.end(), 0.0);
  std::fill(radius_.begin(), radius_.end(), 0.0);
}

double ModelSeries::Norm(size_t node, size_t order) const {
  const double* norms = Norms(node, order);
  double sum = 0;
  for (size_t d = 0; d <= degree_; ++d) sum += norms[d];
  return sum;
}

Interval ModelSeries::RangeOfParts(std::span<const double> p, double radius) const {
  double up = 0;
  double down = 0;
  for (size_t i = 1; i < p.size(); ++i) {
    if (monomials_->IsEven(i)) {
      (p[i] > 0 ? up : down) += std::fabs(p[i]);
    } else {
      up += std::fabs(p[i]);
      down += std::fabs(p[i]);
    }
  }
  return Interval::Point(p[0]) + Interval{-Above(down + radius), Above(up + radius)};
}

Interval ModelSeries::Range(size_t node, size_t order) const { return RangeOf(At(node, order)); }
Interval ModelSeries::RangeOf(ModelView model) const { return RangeOfParts(model.polynomial, model.radius); }

void ModelSeries::SetVariable(size_t variable, size_t order, std::span<const double> polynomial,
                              double radius) {
  const size_t node = program_.variable_nodes[variable];
  double* to = Values(node, order);
  std::copy(polynomial.begin(), polynomial.end(), to);
  std::fill(to + polynomial.size(), to + count_, 0.0);
  Radius(node, order) = radius;
  Finish(node, order);
}

void ModelSeries::SetFromDerivative(size_t variable, size_t output, size_t order) {
  const size_t node = program_.variable_nodes[variable];
  const size_t from = program_.outputs[output];
  const double* f = Values(from, order);
  double* to = Values(node, order + 1);
  const auto divisor = static_cast<double>(order + 1);
  for (size_t i = 0; i < count_; ++i) to[i] = f[i] / divisor;
  Radius(node, order + 1) = Above((Radius(from, order) + Above(Norm(from, order)) * Roundings(1)) / divisor +
                                  static_cast<double>(count_) * 0x1p-1070);
  Finish(node, order + 1);
}

void ModelSeries::Finish(size_t node, size_t order) {
  const double* v = Values(node, order);
  double* norms = Norms(node, order);
  for (size_t d = 0; d <= degree_; ++d) {
    double sum = 0;
    for (size_t i = d == 0 ? 0 : monomials_->Count(d - 1); i < monomials_->Count(d); ++i)
      sum += std::fabs(v[i]);
    norms[d] = sum;
  }
  for (const uint32_t o : nodes_[node].packed_as) {
    Operand& operand = operands_[o];
    double weight = 1;
    if (operand.weight == Operand::Weight::kOrder) weight = static_cast<double>(order);
    if (operand.weight == Operand::Weight::kNotFirst && order == 0) weight = 0;
    double* to = operand.packed.data() + (operand.backward ? stride_ - 1 - order : order);
    for (size_t i = 0; i < count_; ++i) to[i * stride_] = weight * v[i];
  }
}

double ModelSeries::Truncation(const double* left, const double* right) const {
  double beyond = 0;  // the norm of right's parts of degree > degree_ - d
  double sum = 0;
  for (size_t d = 1; d <= degree_; ++d) {
    beyond += right[degree_ + 1 - d];
    sum += left[d] * beyond;
  }
  return sum;
}

double ModelSeries::Convolution(const Sum& sum, size_t order, double* out) {
  const Operand& left = operands_[sum.left];
  const Operand& right = operands_[sum.right];
  const Pairs pairs{monomials_->pair_begin().data(), monomials_->left().data(), monomials_->right().data()};
  const size_t blocks = order / kWidth + 1;
  convolve_(pairs, count_, left.packed.data(), stride_, right.packed.data() + (stride_ - 1 - order), stride_,
            blocks, out);
  const size_t summands = monomials_->longest() * blocks * kWidth;
  const double roundings = Roundings(static_cast<double>(summands + 8));
  double error = 0;
  for (size_t a = 0; a <= order; ++a) {
    double weight = 1;
    if (left.weight == Operand::Weight::kOrder) weight = static_cast<double>(a);
    if (left.weight == Operand::Weight::kNotFirst && a == 0) weight = 0;
    if (weight == 0) continue;
    const size_t b = order - a;
    // What has not been computed yet is zero, and multiplied by zero.
    const double na = Norm(left.node, a);
    const double nb = Norm(right.node, b);
    const double ra = Radius(left.node, a);
    const double rb = Radius(right.node, b);
    error += weight * (Truncation(Norms(left.node, a), Norms(right.node, b)) + na * rb + nb * ra + ra * rb +
                       na * nb * roundings);
  }
  return Above(error + static_cast<double>(count_ * orders_ * monomials_->longest()) * 0x1p-1070);
}

void ModelSeries::LinearNode(size_t node, size_t order) {
  const Code& c = program_.code[node];
  double* out = Values(node, order);
  std::fill(out, out + count_, 0.0);
  double radius = 0;
  double magnitude = 0;
  if (order == 0) {
    out[0] = program_.constants[node].factor;
    radius = program_.constants[node].error;
    magnitude = std::fabs(out[0]);
  }
  for (uint32_t p = c.a; p < c.a + c.b; ++p) {
    const LinearPart& part = program_.parts[p];
    const double* from = Values(part.node, order);
    for (size_t i = 0; i < count_; ++i) out[i] += part.factor * from[i];
    const double norm = Norm(part.node, order);
    const double r = Radius(part.node, order);
    magnitude += std::fabs(part.factor) * norm;
    radius += std::fabs(part.factor) * r + part.error * (norm + r);
  }
  Radius(node, order) = Above(radius + Above(magnitude) * Roundings(c.b + 2) +
                              static_cast<double>(count_ * (c.b + 1)) * 0x1p-1070);
}

void ModelSeries::Multiply(const Model& a, const Model& b, Model& out) const {
  out.polynomial.resize(count_);
  MultiplyInto(a.polynomial.data(), a.radius, b, out.polynomial.data(), out.radius);
}

void ModelSeries::MultiplyInto(const double* a, double a_radius, const Model& b, double* out,
                               double& radius) const {
  const auto begin = monomials_->pair_begin();
  const auto left = monomials_->left();
  const auto right = monomials_->right();
  for (size_t k = 0; k < count_; ++k) {
    double sum = 0;
    for (uint32_t p = begin[k]; p < begin[k + 1]; ++p) sum += a[left[p]] * b.polynomial[right[p]];
    out[k] = sum;
  }
  std::vector<double> na(degree_ + 1), nb(degree_ + 1);
  double ta = 0;
  double tb = 0;
  for (size_t i = 0; i < count_; ++i) {
    const size_t d = monomials_->DegreeOf(i);
    na[d] += std::fabs(a[i]);
    nb[d] += std::fabs(b.polynomial[i]);
    ta += std::fabs(a[i]);
    tb += std::fabs(b.polynomial[i]);
  }
  radius = Above(Truncation(na.data(), nb.data()) + ta * b.radius + tb * a_radius + a_radius * b.radius +
                 ta * tb * Roundings(static_cast<double>(monomials_->longest()) + 2) +
                 static_cast<double>(count_ * monomials_->longest()) * 0x1p-1070);
}

void ModelSeries::KinkNode(size_t node, size_t order, Branch branch, Interval held) {
  const Code& c = program_.code[node];
  double* out = Values(node, order);
  const auto copy = [&](size_t from, double factor) {
    const double* v = Values(from, order);
    for (size_t i = 0; i < count_; ++i) out[i] = factor * v[i];
    Radius(node, order) = Radius(from, order);
  };
  if (c.op == CodeOp::kAbs && branch != Branch::kEither) return copy(c.a, branch == Branch::kFirst ? 1 : -1);
  if (c.op == CodeOp::kChoose && branch != Branch::kEither)
    return copy(branch == Branch::kFirst ? c.b : c.c, 1);
  if (c.op == CodeOp::kMax && branch != Branch::kEither) return copy(branch == Branch::kFirst ? c.a : c.b, 1);
  std::fill(out, out + count_, 0.0);
  Radius(node, order) = 0;
  if (order > 0) return;
  const auto [middle, error] = Centred(held);
  if (last_ > 0) {  // a flow: the middle, and the caller accounts for the rest
    out[0] = middle;
    return;
  }
  CHECK(c.op == CodeOp::kChoose);  // maps replace maxima and absolute values that are open (flow/kinks.h)
  const double* first = Values(c.b, 0);
  const double* second = Values(c.c, 0);
  // Either value: their mean, and half their difference as error.
  double apart = 0;
  double norm = 0;
  for (size_t i = 0; i < count_; ++i) {
    out[i] = 0.5 * (first[i] + second[i]);
    apart += std::fabs(first[i] - second[i]);
    norm += std::fabs(first[i]) + std::fabs(second[i]);
  }
  Radius(node, 0) = Above(0.5 * apart + norm * Roundings(4) + std::fmax(Radius(c.b, 0), Radius(c.c, 0)));
}

bool ModelSeries::Compute(size_t order, const std::vector<Branch>& branches,
                          const std::vector<Interval>& held, uint32_t first_node, uint32_t end_node) {
  for (uint32_t n = first_node; n < end_node; ++n) {
    switch (program_.code[n].op) {
      case CodeOp::kVariable:
        continue;
      case CodeOp::kLinear:
        LinearNode(n, order);
        break;
      case CodeOp::kProduct:
        Radius(n, order) = Convolution(nodes_[n].sums[0], order, Values(n, order));
        break;
      case CodeOp::kReciprocal:
      case CodeOp::kRoot:
      case CodeOp::kSine:
      case CodeOp::kCosine:
      case CodeOp::kExp:
      case CodeOp::kLog:
      case CodeOp::kAtan:
      case CodeOp::kAtan2:
        if (order > 0) {
          FunctionOrder(n, order);
        } else if (!FunctionNode(n)) {
          return false;
        }
        break;
      case CodeOp::kAbs:
      case CodeOp::kMax:
      case CodeOp::kChoose:
        KinkNode(n, order, branches[n], held[n]);
        break;
    }
    Finish(n, order);
    if (!std::isfinite(Radius(n, order)) || !std::isfinite(Norm(n, order))) return false;
  }
  return true;
}

}  // namespace rondo::reach
