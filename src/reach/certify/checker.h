#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "reach/problem/invariant.h"
#include "reach/problem/paving.h"

/// The independent checker of reachability proofs. It shares with the engine that finds them what a problem
/// is and means (`reach/problem`) and interval arithmetic (`interval`), nothing else.
namespace rondo::reach::certify {

/// Records how one part of the initial set was followed.
struct PartRecord {
  /// Says which half of a side was taken.
  struct Cut {
    size_t side;  ///< the index of a state that is no copy of another
    bool upper;
  };
  /// Records what was done next.
  struct Step {
    /// Says what a step does; lengths, events and symbols are given with those that need them.
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
    size_t event = 0;     ///< of kCross: which event, by its index in the problem
    double together = 0;  ///< seconds after the event before the set is brought to one instant
    /// Of kCross: when a start meets the event, in seconds after the step began, as a polynomial in the
    /// symbols: pairs of exponents (by symbol) and coefficient.
    std::vector<std::pair<std::vector<uint32_t>, double>> time = {};
    size_t symbol = 0;  ///< of kSplit: which symbol is halved
  };
  std::vector<Cut> path;    ///< from the whole initial set to the part
  std::vector<Step> steps;  ///< none if nothing in the part satisfies what is assumed
};

/// Is what a proof of a problem leaves behind. Nothing in it is believed: its parts must be all of the
/// initial set (the leaves of one binary tree of cuts), and its steps are what is tried first.
struct Certificate {
  std::vector<PartRecord> parts;  ///< none if every claim follows from the invariant
  /// Holds at all times; the claims that follow from it are shown by it, the others by the parts.
  std::optional<Invariant> invariant = std::nullopt;
  std::optional<Paving> paving = std::nullopt;  ///< shows all claims; then there is nothing else
};

/// Is the answer of the checker.
struct Acceptance {
  bool accepted = false;
  std::string reason;  ///< why the certificate is not accepted; empty if it is
  size_t steps = 0;    ///< steps of the flow that were shown, over all parts
  size_t boxes = 0;    ///< on which an invariant was shown
};

/// Shows again that every claim of the problem holds on every trajectory that begins in the initial set.
///
/// Each step is shown after the fact: a polynomial in the initial state and time is found in any way, and
/// bounded is by how much it fails to solve the differential equation (its defect), and how errors grow.
/// Guarantee: what is accepted holds. Cost: some times that of the proof.
Acceptance Check(const Problem& problem, const Certificate& certificate, unsigned jobs,
                 const base::StopToken& stop);

}  // namespace rondo::reach::certify
