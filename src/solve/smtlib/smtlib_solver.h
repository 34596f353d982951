#pragma once

#include "base/result.h"
#include "solve/solver.h"

/// Solvers that are other programs.
namespace rondo::solve::smtlib {

/// Asks any program that reads an SMT-LIB 2 script from standard input and prints `sat`, `unsat` or
/// `unknown`. Gives verdicts only: no core, no values.
class SmtLibSolver : public Solver {
 public:
  /// Takes a program and its arguments, separated by blanks; `cvc5` and `z3` get the arguments that they
  /// need.
  explicit SmtLibSolver(const std::string& command);

  std::string name() const override { return name_; }
  /// Asks it nothing, to see whether it answers at all. @error why it does not.
  base::Result<bool> Try() const;
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;

 private:
  std::string name_;
  std::vector<std::string> command_;
};

}  // namespace rondo::solve::smtlib
