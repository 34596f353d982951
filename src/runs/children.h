#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.h"

namespace rondo::runs {

/// Tells how the process of a robot ended.
struct RobotEnd {
  std::string robot;
  int status = 0;  ///< exit status; -1: a signal ended it, or it had to be ended
  int signal = 0;
  std::string output;  ///< the file with what it said
  std::string log;     ///< the file of its log; empty: there is none
};

/// Holds processes of robots; none outlives it.
class Children {
 public:
  Children() = default;
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;
  ~Children() { End(); }

  /// Starts one. What it says goes to `end.output`. @error if that cannot be written, or there are too many processes.
  base::Result<bool> Start(const std::vector<std::string>& arguments, RobotEnd end);
  /// Returns how many still run.
  size_t Running();
  /// Asks all to stop, and ends those that do not.
  void End();
  /// Says how they ended, in the order in which they were started.
  std::vector<RobotEnd> Ends() const;

 private:
  struct Child {
    pid_t pid;
    bool runs;
    RobotEnd end;
  };
  std::vector<Child> children_;
};

/// Lets this process and its children find nobody on other machines, whatever the variables of ROS say.
void StayOnThisMachine();

}  // namespace rondo::runs
