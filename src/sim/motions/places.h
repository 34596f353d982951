#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "choreo/node/cast.h"

namespace rondo::sim::motions {

/// Follows where each robot is in its local type, by what it does: messages and motions. Where alternatives look alike so far,
/// it is in all of them.
class Places {
 public:
  explicit Places(const choreo::Cast& cast);

  /// A robot begins a motion. Where none is due, it goes on with what it waits in.
  void Moves(choreo::RobotId robot);
  /// A robot sends, or takes, a message. Returns the nodes of the choreography that this may be; none if it is nothing that
  /// the choreography says comes next.
  std::vector<choreo::NodeId> Says(choreo::RobotId robot, choreo::Action::Kind kind, choreo::RobotId peer,
                                   const std::string& label);
  /// Reports whether a robot may be at its end now, in motions that may be over.
  bool MayEnd(choreo::RobotId robot);
  /// Returns the steps of the choreography that the present motion of a robot may belong to; none if that is not known.
  const std::vector<choreo::NodeId>& StepsOf(choreo::RobotId robot) const { return steps_[robot.index()]; }
  /// Returns how long, in seconds, its present step lasts at least: as long as the motion of it that takes longest.
  double LeastOf(choreo::RobotId robot) const;
  /// Returns the threads around a node, the outermost first: the fork and which of its branches.
  const std::vector<std::pair<choreo::NodeId, size_t>>& ThreadsAround(choreo::NodeId node) const;

 private:
  using States = std::set<choreo::StateId>;
  void FindThreads();
  void Choose(choreo::RobotId robot);
  States Over(choreo::RobotId robot, std::vector<choreo::NodeId>& nodes, bool idle) const;

  const choreo::Cast& cast_;
  std::vector<States> at_;
  std::vector<std::vector<choreo::NodeId>> steps_;
  std::map<choreo::NodeId, std::vector<std::pair<choreo::NodeId, size_t>>> threads_;
};

}  // namespace rondo::sim::motions
