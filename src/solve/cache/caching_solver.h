#pragma once

#include <atomic>

#include "solve/cache/proof_cache.h"
#include "solve/solver.h"

namespace rondo::solve::cache {

/// Another solver, with its refutations remembered on disk. Only `Unsat` is stored: a model is not worth a
/// file, and ignorance may end with the next version. The engine's name is part of the question, so a new
/// engine asks again.
class CachingSolver : public Solver {
 public:
  CachingSolver(const Solver& solver, const ProofCache& cache) : solver_(solver), cache_(cache) {}

  std::string name() const override { return solver_.name(); }
  Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const override;
  size_t hits() const { return hits_; }

 private:
  const Solver& solver_;
  const ProofCache& cache_;
  mutable std::atomic<size_t> hits_{0};
};

}  // namespace rondo::solve::cache
