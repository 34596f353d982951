#pragma once

#include <atomic>

#include "solve/cache/proof_cache.h"
#include "solve/solver.h"

/// Solvers that remember what they have refuted.
namespace rondo::solve::cache {

/// Asks another solver, and remembers its refutations on disk. Only `Unsat` is stored: a model is not worth a
/// file, and ignorance may end with the next version. The engine's name is part of the question, so a new
/// engine asks again.
class CachingSolver : public Solver {
 public:
  CachingSolver(const Solver& solver, const ProofCache& cache) : solver_(solver), cache_(cache) {}

  std::string name() const override { return solver_.name(); }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  /// Returns how many questions were answered from the disk.
  size_t hits() const { return hits_; }

 private:
  const Solver& solver_;
  const ProofCache& cache_;
  mutable std::atomic<size_t> hits_{0};
};

}  // namespace rondo::solve::cache
