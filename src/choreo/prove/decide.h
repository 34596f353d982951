#pragma once

#include <map>
#include <string>
#include <vector>

#include "choreo/obligations/obligations.h"
#include "expr/numeric.h"
#include "solve/icp/icp_solver.h"
#include "verdict/verdict.h"

/// Decides obligations of choreographies, one at a time (docs/theory.md, "Separation" and "Curves").
namespace rondo::choreo {

/// Names the way that led to the verdict.
enum class Way : uint8_t {
  kSizes,       ///< shapes in one frame: their sizes decide
  kSeparation,  ///< separating directions, over the state alone
  kPoints,      ///< intervals over the state and a point
  kCurve,       ///< a curve of states over the clock
};

/// Holds a state at which an obligation fails, or, for one that asks for a state, holds.
struct Witness {
  expr::Numeric::Point values;  ///< by variable of the obligation; the point of the world among them
  bool exact = true;            ///< the values are the solution; else a solution is near
};

/// Holds the verdict about an obligation, and what it stands on.
struct Decision {
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  Way way = Way::kPoints;
  Witness witness;       ///< kRefuted, or how close it came: the state at which nothing could be excluded
  double apart = 0;      ///< kUnknown, of shapes: at least this far apart there; negative: they overlap
  std::string reason;    ///< kUnknown; kRefuted: more about it, if there is more to say
  size_t questions = 0;  ///< how often the solver was asked
  /// Holds, for kProved, a certificate for each question; none if nothing had to be asked.
  std::vector<std::string> certificates;
};

/// Limits the effort for one obligation.
struct Limits {
  std::chrono::milliseconds time{10'000};
  bool certificates = true;
  bool separation = true;  ///< off: only the general way over points, to compare
};

/// Decides one obligation. Thread-safe: works on copies of the terms. What cannot be decided within the
/// limits is kUnknown, with a reason.
Decision Decide(const Obligation& obligation, const robot::World& world, const expr::Arena& arena,
                const solve::icp::Options& engine, const Limits& limits, const base::StopToken& stop);

}  // namespace rondo::choreo
