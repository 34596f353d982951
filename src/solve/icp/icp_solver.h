#pragma once

#include <limits>

#include "interval/batch.h"
#include "solve/solver.h"

/// Nonlinear real arithmetic with elementary functions by interval branch and prune (docs/theory.md).
namespace rondo::solve::icp {

struct Options {
  unsigned jobs = 1;  ///< threads for one question
  /// A box this narrow in which nothing can be excluded is the answer `DeltaSat`.
  double precision = 1e-9;
  /// Boxes that are wider, in some variable of the query, are `Unknown` instead.
  double widest = std::numeric_limits<double>::infinity();
  uint64_t max_boxes = UINT64_MAX;
  bool lemmas = true;                          ///< look for rotations; off only to measure what that brings
  const interval::Kernels* kernels = nullptr;  ///< none: the best of this machine
};

/// Bounds by variable of the query.
using Box = std::map<expr::TermId, std::pair<double, double>>;

struct Statistics {
  uint64_t boxes = 0;
  uint64_t cases = 0;    ///< conjunctions that were searched
  uint64_t exact = 0;    ///< conjunctions refuted by exact arithmetic alone
  size_t variables = 0;  ///< of the largest search
  size_t nodes = 0;
};

/// Answers: `Unsat` is rigorous; `Sat` comes with values of the variables at which the formula was verified,
/// exactly or with intervals; `DeltaSat` and `Unknown` say so. Quantifiers, arrays, records, lists and
/// uninterpreted functions are `Unknown`.
class IcpSolver : public Solver {
 public:
  explicit IcpSolver(Options options = {}) : options_(options) {}
  std::string name() const override { return "icp"; }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  /// The same, telling how much it took.
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop,
               Statistics& statistics) const;

  /// Bounds of the variables of a query that no solution leaves, by exact arithmetic and contraction alone.
  /// Nothing if there is no solution, or the query cannot be told in intervals. Bounds may be infinite.
  std::optional<Box> Enclose(const Query& query) const;

 private:
  Options options_;
};

}  // namespace rondo::solve::icp
