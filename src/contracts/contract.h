#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "choreo/graph/graph.h"
#include "diag/source.h"
#include "reach/certify/checker.h"
#include "reach/validated/prover.h"
#include "robot/dynamics/motion_problem.h"
#include "verdict/basis.h"
#include "verdict/verdict.h"

/// Finds, decides and certifies contracts of motions and of ports, and keeps them for other proofs.
namespace rondo::contracts {

/// Holds one contract, and what became of it.
struct ContractResult {
  robot::MotionProblem made;
  diag::Span span;                        ///< of the motion
  std::string impossible;                 ///< why there is no problem to decide, if there is none
  std::optional<reach::Outcome> outcome;  ///< what reachability found; nothing: not begun
  double seconds = 0;
  std::optional<reach::certify::Acceptance> certified;  ///< of a proof, by the checker; nothing: not asked
  double certify_seconds = 0;

  /// Reports whether the checker has accepted the proof.
  bool IsCertified() const { return certified && certified->accepted; }
  std::vector<std::string> domain;        ///< what else a proof is limited to
  const choreo::Graph* graph = nullptr;   ///< of a choreography's motion
  std::string motion;                     ///< `Type.Motion`
  std::string model;                      ///< of a port: by which robot type
  std::string same_as;                    ///< the contract whose tube shows this one, too
  std::vector<std::string> anywhere;      ///< parameters that may have any value: it is the same contract
  std::optional<reach::Problem> at_zero;  ///< with zero for each of them: kept if and only if this one is
};

/// Returns what is known of a contract; one that was not begun is unknown.
verdict::Verdict VerdictOf(const ContractResult& result);

/// Returns the word for it in tables; `not begun` is one.
std::string_view Word(const ContractResult& result);

/// Returns what a proof of it rests on.
verdict::Basis BasisOf(const ContractResult& result);

}  // namespace rondo::contracts
