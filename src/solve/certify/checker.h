#pragma once

#include <cstdint>
#include <optional>

#include "base/stop.h"
#include "solve/certify/proof_reader.h"

/// The independent checker of refutations of nonlinear formulas.
namespace rondo::solve::certify {

/// Tells what was checked.
struct Tally {
  uint64_t assertions = 0;
  uint64_t cases = 0;    ///< that were closed
  uint64_t boxes = 0;    ///< of searches
  bool stopped = false;  ///< not checked to the end
};

/// Checks that the proof shows that no values of the variables satisfy all assertions of the script. The
/// first step that does not is reported (`certificate-rejected`). Relies on the reader of scripts, on the
/// simplifications of `expr` and on MPFR; on nothing of the solver. Polls `stop`: then `stopped` is set, and
/// nothing was shown.
Tally Check(const Certificate& certificate, diag::Diagnostics& diagnostics, const base::StopToken& stop);

}  // namespace rondo::solve::certify
