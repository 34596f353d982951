#include "solve/cache/caching_solver.h"

#include <fmt/format.h>

namespace rondo::solve::cache {

Answer CachingSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  // The cache keeps neither values nor certificates.
  if (!query.wanted.empty() || !budget.core || budget.certificate) return solver_.Check(query, budget, stop);
  const std::string question = fmt::format("; {}\n{}", name(), ToSmtLib(query));
  if (const auto entry = cache_.Find(question)) {
    ++hits_;
    return Unsat{entry->core};
  }
  Answer answer = solver_.Check(query, budget, stop);
  if (const auto* unsat = std::get_if<Unsat>(&answer)) cache_.Store(question, {name(), unsat->core});
  return answer;
}

}  // namespace rondo::solve::cache
