#pragma once

#include <cstdint>
#include <optional>

#include "base/stop.h"
#include "solve/certify/proof_reader.h"

namespace rondo::solve::certify {

/// What was checked.
struct Tally {
  uint64_t assertions = 0;
  uint64_t cases = 0;  ///< closed cases
  uint64_t boxes = 0;
  bool stopped = false;  ///< not checked to the end
};

/// Checks that the proof shows that no values of the variables satisfy all assertions of the script. The
/// first step that does not is reported (`certificate-rejected`). Relies on the reader of scripts, on the
/// simplifications of `expr` and on MPFR; on nothing of the solver. Polls `stop`.
Tally Check(const Certificate& certificate, diag::Diagnostics& diagnostics, const base::StopToken& stop);

}  // namespace rondo::solve::certify
