#include "contracts/decide.h"

#include <chrono>

namespace rondo::contracts {

void DecideContract(ContractResult& r, const DecideOptions& options, const base::StopToken& stop) {
  if (!r.impossible.empty() || stop.cancelled()) return;
  reach::ProverOptions prover;
  prover.jobs = options.jobs;
  prover.seed = options.seed;
  prover.progress = options.progress;
  const auto begin = std::chrono::steady_clock::now();
  const base::StopToken limited =
      stop.WithDeadline(begin + std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000)));
  auto outcome = reach::Decide(r.made.problem, prover, limited);
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (outcome.ok()) {
    r.outcome = std::move(outcome).value();
    auto* open = std::get_if<reach::Undecided>(&*r.outcome);
    if (open != nullptr && open->shortfall == verdict::Shortfall::kInterrupted && !stop.cancelled()) {
      open->shortfall = verdict::Shortfall::kTime;
      open->reason = "out of time (--timeout)";
    }
  } else {
    r.impossible = outcome.error().message;
  }
}

}  // namespace rondo::contracts
