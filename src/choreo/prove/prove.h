#pragma once

#include <filesystem>
#include <functional>

#include "choreo/prove/decide.h"
#include "choreo/prove/routes.h"
#include "solve/cache/proof_cache.h"

/// Proves choreographies.
namespace rondo::choreo {

/// Holds what became of one obligation.
struct Proof {
  Decision decision;
  double seconds = 0;
  bool cached = false;           ///< it was known from an earlier run
  bool certified = false;        ///< it is proved, and the checker has accepted every certificate
  bool interrupted = false;      ///< it is unknown because somebody stopped the proof
  bool confirmed = false;        ///< it is refuted, and FCL sees the contact of the witness as well
  std::vector<Turn> turns = {};  ///< it is refuted: what is decided on the way there (`FindRuns`)
  size_t rounds = 0;  ///< it is not inductive: no run breaks it that comes so often to any place at most
};

/// Says how obligations are decided.
struct ProveOptions {
  Limits limits;
  unsigned jobs = 0;                                ///< 0: one for each core
  const solve::cache::ProofCache* cache = nullptr;  ///< of proofs; nullptr: all are proved anew
  std::filesystem::path smt_out;       ///< where to write the obligations as SMT-LIB 2; empty: nowhere
  std::filesystem::path certificates;  ///< where to write certificates; empty: nowhere
  base::StopToken stop;
  /// Receives how many obligations are done, how many there are, and which is done now; one call at a time.
  std::function<void(size_t, size_t, const std::string&)> progress;
};

/// Holds what became of all obligations.
struct Proofs {
  std::vector<Proof> all;             ///< in the order of the obligations
  std::vector<std::string> problems;  ///< files that could not be written; certificates that were rejected
  bool bug = false;                   ///< a certificate was rejected, which is a bug of ours
};

/// Decides all obligations of one choreography, on several threads. What is proved is certified, unless
/// `limits.certificates` is off: the certificates are checked at once, and one that is rejected proves
/// nothing.
Proofs Prove(const Obligations& obligations, const Graph& graph, const expr::Arena& arena,
             const ProveOptions& options);

}  // namespace rondo::choreo
