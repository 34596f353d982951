#pragma once

#include <filesystem>

#include "solve/icp/icp_solver.h"
#include "solve/solver.h"

namespace rondo::solve::portfolio {

struct Options {
  icp::Options icp;
  std::vector<const Solver*> others;  ///< run beside interval arithmetic once that has not answered soon
  /// Waits for all engines and compares their answers.
  bool compare = false;
  /// Where to write the question when two engines contradict each other.
  std::filesystem::path reproducer = "rondo-disagreement.smt2";
};

/// What one engine said.
struct Outcome {
  std::string engine;
  std::string answer;  ///< `unsat`, `sat`, `delta-sat`, or why it does not know
  double seconds = 0;
};

struct Report {
  Answer answer;
  std::vector<Outcome> outcomes;
  icp::Statistics icp;
  /// Two engines gave different definite answers: one of them is wrong, the answer is Unknown, and the
  /// question stands in the reproducer.
  bool disagreement = false;
};

/// `unsat`, `sat`, `delta-sat`, or the reason of an Unknown.
std::string Describe(const Answer& answer);

/// Cheap first: exact arithmetic and a short interval search; then all engines at once, the first definite
/// answer counts. If none decides, the answer is that of interval arithmetic, and an Unknown tells what each
/// engine said.
class PortfolioSolver : public Solver {
 public:
  explicit PortfolioSolver(Options options) : options_(std::move(options)) {}
  std::string name() const override { return "portfolio"; }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  Report Decide(const Query& query, const Budget& budget, const base::StopToken& stop) const;

 private:
  Options options_;
};

}  // namespace rondo::solve::portfolio
