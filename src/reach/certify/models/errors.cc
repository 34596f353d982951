#include "reach/certify/models/errors.h"

#include <cmath>

#include "reach/certify/models/upward.h"

namespace rondo::reach::certify {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostPerPiece = 0.5;
constexpr double kMostPieces = 4096;
constexpr int kMostTerms = 24;

double Norm(const MatrixXd& m) { return m.size() == 0 ? 0 : m.cwiseAbs().rowwise().sum().maxCoeff(); }
VectorXd UpAll(const VectorXd& v) {
  return v.unaryExpr([](double x) { return Up(x); });
}

// At least exp(B) x for B, x >= 0 with |B| at most 2.
VectorXd Grown(const MatrixXd& b, const VectorXd& x) {
  VectorXd sum = x;
  VectorXd term = x;
  for (int k = 1; k <= kMostTerms; ++k) {
    term = b * term / k;
    sum += term;
  }
  // Every further term is less than half of the one before.
  const double tail = term.size() == 0 ? 0 : term.maxCoeff();
  return UpAll(sum + VectorXd::Constant(x.size(), tail));
}

// The polynomial M of a piece: what is needed of it.
struct Transition {
  MatrixXd end;       // M(1)
  MatrixXd most;      // at least |M(t)|
  MatrixXd residual;  // at least |centre M(t) - M'(t)|
  double terms = 0;
};
Transition PolynomialOf(const MatrixXd& centre) {
  const Index n = centre.rows();
  const double gamma = Gamma(static_cast<double>(2 * n + 8));
  const MatrixXd size = centre.cwiseAbs();
  Transition t;
  MatrixXd term = MatrixXd::Identity(n, n);
  t.end = t.most = term;
  t.residual = MatrixXd::Zero(n, n);
  for (int k = 0; k < kMostTerms; ++k) {
    ++t.terms;
    const MatrixXd product = centre * term;
    const bool last = k + 1 == kMostTerms || Norm(product) < 1e-19;
    const MatrixXd sizes = size * term.cwiseAbs();
    if (last) {
      t.residual += product.cwiseAbs() + gamma * sizes;
      break;
    }
    const MatrixXd next = product / (k + 1);
    t.residual +=
        (product - (k + 1) * next).cwiseAbs() + gamma * sizes + Gamma(4) * (k + 1) * next.cwiseAbs();
    t.end += next;
    t.most += next.cwiseAbs();
    term = next;
  }
  const auto up = [](double x) { return Up(x); };
  t.most = t.most.unaryExpr(up);
  t.residual = t.residual.unaryExpr(up);
  return t;
}

}  // namespace

bool PropagateErrors(const ErrorRates& rates, const MatrixXd& generators, const Push& push, ErrorFlow& out) {
  const Index n = rates.centre.rows();
  const double wanted = std::ceil(std::fmax(Norm(rates.centre), 0.25 * Norm(rates.radius)) / kMostPerPiece);
  if (!(wanted <= kMostPieces)) return false;
  const double pieces = std::fmax(1, wanted);
  const double length = 1 / pieces;
  const MatrixXd centre = rates.centre * length;
  // Pieces are not longer than `length` and both factors are rounded.
  const MatrixXd radius =
      (rates.radius * length + Gamma(4) * centre.cwiseAbs()).unaryExpr([](double x) { return Up(x); });
  const Transition t = PolynomialOf(centre);
  const MatrixXd grows = (centre.cwiseAbs() + radius).unaryExpr([](double x) { return Up(x); });
  if (!(Norm(grows) <= 2)) return false;
  const MatrixXd residual = (radius * t.most + t.residual).unaryExpr([](double x) { return Up(x); });
  out.generators = generators;
  out.most = VectorXd::Zero(n);
  out.added = VectorXd::Zero(n);
  for (size_t index = 0; index < static_cast<size_t>(pieces); ++index) {
    const auto piece = static_cast<double>(index);
    const VectorXd before = UpAll(out.generators.cwiseAbs().rowwise().sum());
    // The integral of the push over this piece, [piece, piece + 1] / pieces, a little enlarged.
    VectorXd pushed = residual * before;
    const double from = piece * length * (1 - 0x1p-50);
    const double to = (piece + 1) * length * (1 + 0x1p-50);
    for (size_t a = 0; a < push.by_power.size(); ++a) {
      // t^a is at most what it is at the end of the piece; over one piece, what its integral is.
      const double k = static_cast<double>(a) + 1;
      const double share = pieces == 1 ? 1 / k : std::pow(to, static_cast<double>(a)) * (to - from);
      pushed += push.by_power[a] * Up(share * (1 + 0x1p-40));
    }
    const VectorXd rest = Grown(grows, UpAll(pushed));
    out.most = out.most.cwiseMax(UpAll(t.most * before + rest));
    const MatrixXd next = t.end * out.generators;
    const double gamma = Gamma(static_cast<double>(n) + 2 * t.terms + 4);
    const VectorXd errors = UpAll(rest + gamma * (t.most * before));
    out.added += errors;
    const Index old = next.cols();
    out.generators.resize(n, old + n);
    out.generators.leftCols(old) = next;
    out.generators.rightCols(n) = errors.asDiagonal();
    if (!out.generators.allFinite()) return false;
  }
  return true;
}

}  // namespace rondo::reach::certify
