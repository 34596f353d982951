#pragma once

#include "solve/solver.h"

namespace rondo::solve::z3 {

/// Z3 in this process, one context for each call. Handles everything the terms can say; lists are
/// uninterpreted (assert `expr::ListAxioms`). Unsatisfiable cores are by group and minimised by Z3.
class Z3Solver : public Solver {
 public:
  std::string name() const override;
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
};

}  // namespace rondo::solve::z3
