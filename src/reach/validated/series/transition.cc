#include "reach/validated/series/transition.h"

#include <cmath>

#include "reach/validated/series/bound.h"

namespace rondo::reach {

void Propagate(std::span<const Interval> rates, size_t dimension, double h, Transition& out) {
  const auto n = static_cast<Eigen::Index>(dimension);
  Eigen::MatrixXd centre(n, n), radius(n, n), size(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Interval a = rates[static_cast<size_t>(i * n + j)];
      centre(i, j) = a.lo == a.hi ? a.lo : a.lo * 0.5 + a.hi * 0.5;
      radius(i, j) = a.lo == a.hi ? 0 : Above(std::fmax(a.hi - centre(i, j), centre(i, j) - a.lo));
      size(i, j) = std::fmax(std::fabs(a.lo), std::fabs(a.hi));
    }
  }
  const double norm = n == 0 ? 0 : Above(size.rowwise().sum().maxCoeff());
  // h = t * 2^squarings, exactly.
  int squarings = 0;
  double t = h;
  while (norm * t > 0.5 && squarings < 60) {
    t *= 0.5;
    ++squarings;
  }
  const double a = Above(norm * t);
  int terms = 1;
  double rest = a * a / 2;
  while (rest > 0x1p-56 && terms < 30) {
    ++terms;
    rest *= a / (terms + 1);
  }
  rest = Above(rest * 2);  // the rest of the exponential series, since a <= 1/2

  const double relative = Roundings(static_cast<double>(n) + 4);
  const Eigen::MatrixXd all = size * (1 + 0x1p-50);
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(n, n);  // of A t, divided by the factorial
  Eigen::MatrixXd power_radius = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd power_growth = power;
  out.centre = power;
  out.radius = Eigen::MatrixXd::Constant(n, n, rest);
  out.growth = power;
  const Eigen::MatrixXd centre_size = centre.cwiseAbs();
  for (int k = 1; k <= terms; ++k) {
    const double share = t / k;
    const Eigen::MatrixXd before = power.cwiseAbs();
    power_radius = (share * (before * (radius + relative * centre_size) + power_radius * all)).eval();
    power = (share * (power * centre)).eval();
    power_growth = (share * (power_growth * all)).eval();
    out.centre += power;
    out.radius += power_radius + (kHalfUlp * 2) * (out.centre.cwiseAbs() + power.cwiseAbs());
    out.growth += power_growth;
  }
  const auto above = [](double x) { return Above(x); };
  out.radius = out.radius.unaryExpr(above).eval();
  out.growth = (out.growth.array() + rest).matrix().unaryExpr(above).eval();
  for (int s = 0; s < squarings; ++s) {
    const Eigen::MatrixXd magnitude = out.centre.cwiseAbs();
    out.radius = (magnitude * (out.radius + relative * magnitude) + out.radius * (magnitude + out.radius))
                     .unaryExpr(above)
                     .eval();
    out.centre = (out.centre * out.centre).eval();
    out.growth = (out.growth * out.growth).unaryExpr(above).eval();
  }
}

}  // namespace rondo::reach
