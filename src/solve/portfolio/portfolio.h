#pragma once

#include <filesystem>

#include "solve/icp/icp_solver.h"
#include "solve/solver.h"

/// Several engines for one question.
namespace rondo::solve::portfolio {

/// Says which engines are asked, and how.
struct Options {
  icp::Options icp;
  std::vector<const Solver*> others;  ///< run beside interval arithmetic once that has not answered soon
  /// Whether to wait for all engines and compare their answers.
  bool compare = false;
  /// Where the question is written, as SMT-LIB, when two engines contradict each other.
  std::filesystem::path reproducer = "rondo-disagreement.smt2";
};

/// Is what one engine said.
struct Outcome {
  std::string engine;
  std::string answer;  ///< `unsat`, `sat`, `delta-sat`, or why it does not know
  double seconds = 0;
};

/// Is the answer, and what each engine contributed to it.
struct Report {
  Answer answer;
  std::vector<Outcome> outcomes;
  icp::Statistics icp;
  /// Two engines gave different definite answers: one of them is wrong, the answer is Unknown, and the
  /// question stands in the reproducer.
  bool disagreement = false;
};

/// Returns `unsat`, `sat`, `delta-sat`, or the reason of an Unknown.
std::string Describe(const Answer& answer);

/// Asks cheap engines first: exact arithmetic and a short interval search; then all engines at once, the
/// first definite answer counts. If none decides, the answer is that of interval arithmetic, and an Unknown
/// tells what each engine said. Without other engines, interval arithmetic has all of the budget.
class PortfolioSolver : public Solver {
 public:
  explicit PortfolioSolver(Options options) : options_(std::move(options)) {}
  std::string name() const override { return "portfolio"; }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  /// Does what Check does, and tells what each engine said.
  Report Decide(const Query& query, const Budget& budget, const base::StopToken& stop) const;

 private:
  Options options_;
};

}  // namespace rondo::solve::portfolio
