#pragma once

#include <string>
#include <vector>

#include "base/stop.h"
#include "reach/problem/problem.h"

/// The independent checker of reachability proofs. It shares with the engine that finds them what a problem
/// is and means (`reach/system`) and interval arithmetic (`interval`), nothing else.
namespace rondo::reach::certify {

/// How one part of the initial set was followed.
struct PartRecord {
  /// Which half of a side.
  struct Cut {
    size_t side;  ///< a state, no copy
    bool upper;
  };
  /// What was done next.
  struct Step {
    enum class Kind : uint8_t {
      kStep,     ///< some time along the flow
      kCross,    ///< all of the set meets an event
      kSplit,    ///< a symbol is halved: first all steps of the lower half, then all of the upper one
      kSeveral,  ///< several modes are possible meanwhile; without a length: each of them on its own from
                 ///< here on
    };
    double length = 0;  ///< seconds; of kCross: until all of the set has met the event
    size_t degree = 0;  ///< of polynomials in the initial state
    Kind kind = Kind::kStep;
    size_t event = 0;
    double together = 0;  ///< seconds after the event before the set is brought to one instant
    /// Of kCross: when a start meets the event, in seconds, as a polynomial: exponents by symbol, factor.
    std::vector<std::pair<std::vector<uint32_t>, double>> time = {};
    size_t symbol = 0;
  };
  std::vector<Cut> path;    ///< from the whole initial set to the part
  std::vector<Step> steps;  ///< none if nothing in the part satisfies what is assumed
};

/// What a proof of a problem leaves behind. Nothing in it is believed: its parts must be all of the initial
/// set, and its steps are what is tried first.
struct Certificate {
  std::vector<PartRecord> parts;
};

struct Acceptance {
  bool accepted = false;
  std::string reason;  ///< why not
  size_t steps = 0;
};

/// Shows again that every claim of the problem holds on every trajectory that begins in the initial set.
///
/// Each step is shown after the fact: a polynomial in the initial state and time is found in any way, and
/// bounded is by how much it fails to solve the differential equation (its defect), and how errors grow.
/// Guarantee: what is accepted holds. Cost: some times that of the proof.
Acceptance Check(const Problem& problem, const Certificate& certificate, unsigned jobs,
                 const base::StopToken& stop);

}  // namespace rondo::reach::certify
