#pragma once

#include <limits>

#include "interval/batch.h"
#include "solve/solver.h"

/// Nonlinear real arithmetic with elementary functions by interval branch and prune (docs/theory.md).
namespace rondo::solve::icp {

/// Says how the solver searches.
struct Options {
  unsigned jobs = 1;  ///< threads for one question
  /// How narrow a box in which nothing can be excluded has to be for the answer `DeltaSat`.
  double precision = 1e-9;
  /// How wide it may be in a variable of the query; with a wider one the answer is `Unknown`.
  double widest = std::numeric_limits<double>::infinity();
  /// How many boxes one question may take; then the answer is `Unknown`.
  uint64_t max_boxes = UINT64_MAX;
  bool lemmas = true;  ///< look for rotations; off only to measure what that brings
  /// How many boxes of one case are tried before sums are tied to rotated frames: more terms make every box
  /// cost more.
  uint64_t boxes_before_links = 1000;
  const interval::Kernels* kernels = nullptr;  ///< none: the best of this machine
};

/// Holds bounds (lower, upper) by variable of the query.
using Box = std::map<expr::TermId, std::pair<double, double>>;

/// Tells how much an answer took.
struct Statistics {
  uint64_t boxes = 0;    ///< that were looked at
  uint64_t cases = 0;    ///< conjunctions that were searched
  uint64_t exact = 0;    ///< conjunctions refuted by exact arithmetic alone
  size_t variables = 0;  ///< of the largest search
  size_t nodes = 0;      ///< of the tape of the largest search
};

/// Decides formulas of nonlinear real arithmetic by interval branch and prune. `Unsat` is rigorous; `Sat`
/// comes with values of the variables at which the formula was verified, exactly or with intervals, or near
/// which a solution was proved to exist; `DeltaSat` and `Unknown` say so. Quantifiers, arrays, records, lists
/// and uninterpreted functions are `Unknown`.
class IcpSolver : public Solver {
 public:
  explicit IcpSolver(Options options = {}) : options_(options) {}
  std::string name() const override { return "icp"; }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  /// Does the same, telling how much it took.
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop,
               Statistics& statistics) const;

  /// Returns bounds of the variables of a query that no solution leaves, by exact arithmetic and contraction
  /// alone. Nothing if there is no solution, or the query cannot be told in intervals. Bounds may be
  /// infinite.
  std::optional<Box> Enclose(const Query& query) const;

 private:
  Options options_;
};

}  // namespace rondo::solve::icp
