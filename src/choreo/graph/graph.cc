#include "choreo/graph/graph.h"

namespace rondo::choreo {

std::string Graph::Names(const Scope& scope) const {
  std::string text;
  size_t left = scope.size();
  for (const RobotId r : scope) {
    text += "`" + NameOf(r) + "`";
    --left;
    if (left > 0) text += left == 1 ? " and " : ", ";
  }
  return text;
}

std::optional<RobotId> Graph::Find(std::string_view robot) const {
  for (size_t i = 0; i < robots.size(); ++i) {
    if (robots[i].text == robot) return RobotId(i);
  }
  return std::nullopt;
}

}  // namespace rondo::choreo
