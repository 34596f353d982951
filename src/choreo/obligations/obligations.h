#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "choreo/process/typing.h"
#include "robot/separation/meeting.h"

/// States what must hold so that a well-formed choreography can be trusted: formulas for a solver (Section 4
/// of the paper: compatibility of motions; [T-Motion], [AGComp], [T-Sess]). Time is continuous: `clock`
/// ranges over the duration of a motion, in seconds.
namespace rondo::choreo {

/// Names what an obligation is about.
enum class ObligationKind : uint8_t {
  kHull,          ///< the hull of a robot contains its body
  kInitial,       ///< bodies are apart, and stand nowhere in obstacles, when it begins
  kPrecondition,  ///< the precondition of a motion holds where it begins
  kAssumption,    ///< what a motion assumes follows from what the others of the step promise, all the time
  kGuarantee,     ///< what a thread guarantees holds all the time
  kBody,          ///< the body stays within the footprint, all the time
  kCollision,     ///< two robots of a step keep apart
  kObstacle,      ///< a robot keeps apart from an obstacle
  kRegion,        ///< a robot keeps to the region of its thread
  kFork,          ///< regions of threads are disjoint, and within the region of their parent
  kThread,        ///< what a thread assumes follows from what the others guarantee
  kTotalChoice,   ///< some guard of a choice holds
  kMessage,       ///< the guard of a message holds, and it carries what it promises
  kContract,      ///< pre, during and post of a motion can hold
  kKeeping,       ///< the motions of a step can be kept at every moment, by continuous states
  kInterrupted,   ///< what a motion promises holds whenever a message may end it
  kStart,         ///< `during` of a motion holds as it begins; if not, its controller has to bridge that
  kProcess,       ///< what the typing of a process leaves open
  kReached,       ///< it can happen that a motion begins; if not, nothing is said about it
};

/// Reports whether an obligation of this kind has to hold. The others tell what a proof rests on.
bool IsRequired(ObligationKind kind);

/// Holds what has to be possible in a step: from each start there is one continuous curve of the states that
/// it moves, on which `during` holds at every moment and `post` at the end. Curves may begin beside the
/// start, if it is no farther than a bridge (docs/theory.md, "Curves").
struct Keeping {
  std::vector<expr::TermId> moving;  ///< states that the motions of the step modify
  std::vector<expr::TermId> before;  ///< for each of them: what it is when the step begins
  std::vector<expr::TermId> others;  ///< what else may change meanwhile, continuously: inputs, environment
  std::vector<expr::TermId> others_before;  ///< for each of them: what it is when the step begins
  std::vector<expr::Rational> bridges;  ///< for each of them: how far `during` may begin from there; SI units
  std::vector<expr::TermId> starts;     ///< where the step may begin, over `before`: one of these holds
  expr::TermId given;    ///< what others keep at every moment: over states, inputs and the environment
  expr::TermId during;   ///< over `moving` and the clock, and over others; ranges are part of it
  expr::TermId post;     ///< of motions that cannot be interrupted
  expr::Rational least;  ///< seconds that the step takes, at least
  std::optional<expr::Rational> most;  ///< at most; none: for ever, if nobody interrupts it
  bool ends = false;                   ///< some motion cannot be interrupted, so that it has to end
  bool chooses = false;  ///< whose controller chooses when, and nobody else has to keep anything meanwhile
};

/// Holds what is to be shown: that `formula` has no solution together with `rest`; or, if `satisfiable`, that
/// it has one; or, if there is a `keeping`, that (`formula` only names it).
struct Obligation {
  ObligationKind kind = ObligationKind::kContract;
  diag::Span span;
  std::string title;    ///< what holds: "the precondition of `cart: Move(1 m)`"
  std::string failure;  ///< what is the matter if not: "the precondition of `cart: Move(1 m)` may not hold"
  bool satisfiable = false;
  expr::TermId formula;
  /// Holds what else is known, about other variables than `formula`: it matters only if it is contradictory.
  expr::TermId rest;
  std::optional<robot::Meeting> meeting;  ///< what `formula` says, if it is about shapes
  std::optional<Keeping> keeping;
  /// Lists the motions, messages and choices that it is about: the first, and others of which the same was
  /// stated.
  std::vector<NodeId> nodes;
  std::vector<size_t> instances;  ///< the motions that it is about
  /// Says that it is about the way to where `during` begins: it holds if kStart holds at the same nodes.
  bool bridge = false;
};

/// Returns the first node that an obligation is about, if it is about one.
inline NodeId NodeOf(const Obligation& o) { return o.nodes.empty() ? NodeId() : o.nodes.front(); }

/// Names what cannot even be stated: a body or a region that is missing, assumptions that rest on each other.
struct Missing {
  diag::Span span;
  std::string what;
  bool region = false;  ///< of a thread
};

/// Holds all obligations of one choreography.
struct Obligations {
  std::vector<Obligation> all;  ///< equal formulas once
  std::vector<Missing> missing;
};

/// Returns every obligation of a choreography that is well-formed. If all of them hold, nothing is missing
/// and all contracts are kept, then no two bodies ever meet, no body meets an obstacle, every motion begins
/// where it may, every choice has an alternative, and every message is as it says. Cost: squares of the
/// number of robots in a step and of threads in a fork, linear in the graph otherwise.
/// @param conditions  what the typing of processes leaves open; each becomes an obligation.
/// @param proved  motions (`Type.Motion`) whose controllers were proved to keep their contracts, so that
/// these can be kept.
Obligations ObligationsOf(const Graph& graph, expr::Arena& arena,
                          const std::vector<SideCondition>& conditions = {},
                          const std::set<std::string>& proved = {});

/// Returns the name of the kind, as reports and JSON have it.
std::string_view KindName(ObligationKind kind);

}  // namespace rondo::choreo
