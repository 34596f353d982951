#pragma once

#include <filesystem>
#include <functional>

#include "choreo/prove/decide.h"
#include "solve/cache/proof_cache.h"

namespace rondo::choreo {

/// One obligation and what became of it.
struct Proof {
  Decision decision;
  double seconds = 0;
  bool cached = false;       ///< known from an earlier run
  bool certified = false;    ///< proved, and the checker has accepted every certificate
  bool interrupted = false;  ///< unknown, because it was stopped by hand
  bool confirmed = false;    ///< refuted, and FCL sees the contact of the witness as well
};

struct ProveOptions {
  Limits limits;
  unsigned jobs = 0;                                ///< 0: one for each core
  const solve::cache::ProofCache* cache = nullptr;  ///< none: everything anew
  std::filesystem::path smt_out;       ///< where to write the obligations as SMT-LIB 2; empty: nowhere
  std::filesystem::path certificates;  ///< where to write certificates; empty: nowhere
  base::StopToken stop;
  /// (how many are done, how many there are, what); one call at a time.
  std::function<void(size_t, size_t, const std::string&)> progress;
};

struct Proofs {
  std::vector<Proof> all;             ///< for each obligation
  std::vector<std::string> problems;  ///< files that could not be written; certificates that were rejected
  bool bug = false;                   ///< a certificate was rejected
};

/// Decides all obligations of one choreography, on several threads. What is proved is certified, unless
/// `limits.certificates` is off: the certificates are checked at once, and one that is rejected proves
/// nothing.
Proofs Prove(const Obligations& obligations, const Graph& graph, const expr::Arena& arena,
             const ProveOptions& options);

}  // namespace rondo::choreo
