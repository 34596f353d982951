#pragma once

#include <functional>
#include <string>

#include "choreo/process/flow.h"
#include "choreo/process/typing.h"

/// Says in which way a process does not do what its choreography asks of its robot.
namespace rondo::choreo {

/// Reports mismatches of one process and one local type. Each function returns false, for the rule that does
/// not apply; none reports while alternatives are tried.
class Mismatch {
 public:
  Mismatch(const Flow& flow, const Graph& graph, const LocalType& type, diag::Diagnostics& diagnostics);

  /// Counts the alternatives that are being tried at the moment, one within the other.
  int trying = 0;

  /// Calls `report` unless alternatives are tried.
  bool Report(const std::function<void()>& report) const;
  /// The step, which `does` something ("sends `a` to `b`"), is not among what the choreography asks for.
  bool Step(FlowId at, StateId state, std::string_view does) const;
  bool Peer(FlowId at, StateId state, const Action& asked) const;
  bool Label(FlowId at, StateId state, const Action& asked) const;
  /// It waits where the choreography has a motion.
  bool Waits(FlowId at, StateId state, const Action& motion) const;
  /// A message may come for which there is no case; or one from another robot, if `other` is given.
  bool NoCase(FlowId at, StateId state, const Action& message, const FlowCase* other) const;
  /// It moves where a message may come.
  bool NobodyListens(FlowId at, StateId state, const Action& message) const;
  /// It goes on at `way` as no alternative of the choice in `state` does.
  bool NoAlternative(FlowId way, StateId state) const;
  /// It goes on at `way` with an alternative that is never open where it `chooses` this way.
  bool NeverOffered(FlowId chooses, FlowId way, StateId state) const;

 private:
  std::string Asked(StateId state) const;
  void AtNodes(diag::Diagnostic& report, StateId state) const;
  diag::Span FirstNode(StateId state, const Action& action) const;

  const Flow& flow_;
  const Graph& graph_;
  const LocalType& type_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace rondo::choreo
