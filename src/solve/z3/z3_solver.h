#pragma once

#include "solve/solver.h"

/// Z3 as a solver.
namespace rondo::solve::z3 {

/// Asks Z3 in this process, one context for each call. Handles everything the terms can say; lists are
/// uninterpreted (assert `expr::ListAxioms`). Unsatisfiable cores are by group. A call ends within a third of
/// a second of its deadline, whether Z3 does or not.
class Z3Solver : public Solver {
 public:
  std::string name() const override;
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
};

/// Reports whether some call returned although Z3 went on. Then a thread may still be running: leave the
/// process without tearing anything down.
bool LeftBehind();

}  // namespace rondo::solve::z3
