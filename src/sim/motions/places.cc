#include "sim/motions/places.h"

#include <algorithm>
#include <optional>

namespace rondo::sim::motions {

using choreo::Action;
using choreo::Node;
using choreo::NodeId;
using choreo::NodeKind;
using choreo::RobotId;
using choreo::StateId;

Places::Places(const choreo::Cast& cast)
    : cast_(cast), at_(cast.types.size(), {StateId(0)}), steps_(cast.types.size()) {
  FindThreads();
}

void Places::FindThreads() {
  const choreo::Graph& graph = *cast_.graph;
  std::vector<std::pair<NodeId, std::vector<std::pair<NodeId, size_t>>>> todo{{graph.start, {}}};
  while (!todo.empty()) {
    auto [id, around] = std::move(todo.back());
    todo.pop_back();
    const Node& node = graph[id];
    if (node.kind == NodeKind::kJoin) continue;  // its fork goes on behind it
    if (!threads_.emplace(id, around).second) continue;
    if (node.kind != NodeKind::kFork) {
      for (const NodeId next : node.next) todo.emplace_back(next, around);
      continue;
    }
    for (size_t b = 0; b < node.next.size(); ++b) {
      auto inner = around;
      inner.emplace_back(id, b);
      todo.emplace_back(node.next[b], std::move(inner));
    }
    if (!node.join.valid()) continue;
    for (const NodeId next : graph[node.join].next) todo.emplace_back(next, around);
  }
}

const std::vector<std::pair<NodeId, size_t>>& Places::ThreadsAround(NodeId node) const {
  static const std::vector<std::pair<NodeId, size_t>> kNone;
  const auto it = threads_.find(node);
  return it == threads_.end() ? kNone : it->second;
}

bool Places::MayEnd(RobotId robot) {
  const choreo::LocalType& type = cast_.types[robot.index()];
  std::vector<NodeId> skipped;
  for (size_t i = 0; i <= type.states.size(); ++i) {
    Choose(robot);
    States& at = at_[robot.index()];
    if (std::ranges::any_of(at, [&](StateId s) { return type.states[s.index()].ends; })) return true;
    States over = Over(robot, skipped, true);
    if (over.empty()) return false;
    at = std::move(over);
  }
  return false;
}

double Places::LeastOf(RobotId robot) const {
  std::optional<double> least;
  for (const NodeId step : steps_[robot.index()]) {
    double longest = 0;
    for (const choreo::Part& part : (*cast_.graph)[step].parts)
      longest = std::max(longest, part.duration.least.ToDouble());
    least = std::min(least.value_or(longest), longest);
  }
  return least.value_or(0);
}

// Choices are made silently: each way is one.
void Places::Choose(RobotId robot) {
  States& at = at_[robot.index()];
  std::vector<StateId> todo(at.begin(), at.end());
  while (!todo.empty()) {
    const StateId s = todo.back();
    todo.pop_back();
    for (const auto& [guard, to] : cast_.types[robot.index()].states[s.index()].choice) {
      if (at.insert(to).second) todo.push_back(to);
    }
  }
}

// Behind the motions that are possible now, and what they are; of `idle` ones those alone that can be over as they begin.
Places::States Places::Over(RobotId robot, std::vector<NodeId>& nodes, bool idle) const {
  States behind;
  for (const StateId s : at_[robot.index()]) {
    const choreo::LocalState& state = cast_.types[robot.index()].states[s.index()];
    for (const auto& [action, to] : state.next) {
      if (action.kind != Action::Kind::kMove) continue;
      const auto& of = state.nodes.at(action);
      const auto part = std::ranges::find((*cast_.graph)[of[0]].parts, robot, &choreo::Part::robot);
      if (idle && !(part->duration.interruptible && part->duration.least.IsZero())) continue;
      behind.insert(to);
      nodes.insert(nodes.end(), of.begin(), of.end());
    }
  }
  return behind;
}

void Places::Moves(RobotId robot) {
  Choose(robot);
  std::vector<NodeId> nodes;
  States behind = Over(robot, nodes, false);
  if (behind.empty()) return;
  at_[robot.index()] = std::move(behind);
  steps_[robot.index()] = std::move(nodes);
}

std::vector<NodeId> Places::Says(RobotId robot, Action::Kind kind, RobotId peer, const std::string& label) {
  const choreo::LocalType& type = cast_.types[robot.index()];
  const Action said{kind, peer, label};
  std::vector<NodeId> nodes, skipped;
  for (size_t i = 0; i <= type.states.size(); ++i) {
    Choose(robot);
    States behind;
    for (const StateId s : at_[robot.index()]) {
      const choreo::LocalState& state = type.states[s.index()];
      const auto it = state.next.find(said);
      if (it == state.next.end()) continue;
      behind.insert(it->second);
      const auto& of = state.nodes.at(said);
      nodes.insert(nodes.end(), of.begin(), of.end());
    }
    if (!behind.empty()) {
      at_[robot.index()] = std::move(behind);
      steps_[robot.index()].clear();
      return nodes;
    }
    States over = Over(robot, skipped, true);
    if (over.empty()) return nodes;
    at_[robot.index()] = std::move(over);
  }
  return nodes;
}

}  // namespace rondo::sim::motions
