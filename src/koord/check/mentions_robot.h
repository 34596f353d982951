#pragma once

#include <set>
#include <vector>

#include "koord/check/model.h"

/// Finds out whether code is about the robot that runs it.
namespace rondo::koord {

/// Tells whether code speaks of the robot that runs it: of `pid`, or of variables and ports of which each
/// robot has its own; by itself, or through the functions that it calls. Functions may call themselves.
/// Cost: linear in the code, and in that of each function once for each call.
class RobotMentions {
 public:
  /// Looks at `model`, which may still be in the making: only names that are resolved count.
  explicit RobotMentions(const Model& model) : model_(model) {}

  /// Reports whether an expression, the statements of a body, or a function speak of the robot.
  bool In(ExprId e);
  bool In(const std::vector<Stmt>& body);
  bool InFunction(size_t function);

 private:
  const Model& model_;
  std::set<size_t> looking_at_;
};

}  // namespace rondo::koord
