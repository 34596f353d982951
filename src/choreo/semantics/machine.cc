#include "choreo/semantics/machine.h"

namespace rondo::choreo {

using Kind = MachineEdge::Kind;

Machine MachineOf(const Graph& graph, const LocalType& type) {
  Machine machine;
  for (const LocalState& s : type.states) {
    MachineState state;
    state.ends = s.ends;
    for (const auto& [action, to] : s.next) {
      MachineEdge edge{Kind::kSend, action.peer, action.label, {}, to.index()};
      switch (action.kind) {
        case Action::Kind::kSend:
          break;
        case Action::Kind::kReceive:
          edge.kind = Kind::kReceive;
          break;
        case Action::Kind::kMove:
          edge.kind = Kind::kMove;
          for (const Part& p : graph[s.nodes.at(action)[0]].parts) {
            if (p.robot == type.robot) edge.duration = p.duration;
          }
          break;
      }
      state.edges.push_back(std::move(edge));
    }
    for (const auto& [guard, to] : s.choice) state.edges.push_back({Kind::kChoose, {}, "", {}, to.index()});
    machine.states.push_back(std::move(state));
  }
  return machine;
}

Machine MachineOf(Graph& graph, const Flow& flow, Declarations& declarations) {
  Machine machine;
  Calls calls(graph, declarations, flow.source->loose_names);
  // The first state is a step to where the process begins.
  machine.states.push_back({{{Kind::kChoose, {}, "", {}, flow.start.index() + 1}}, false});
  for (const FlowNode& node : flow.nodes) {
    MachineState state;
    const auto move = [&](size_t to) {
      const auto instance = calls.Resolve(flow.robot, node.act->motion, graph.BodyOf(flow.robot).scope);
      if (!instance) return;
      const Instance& i = graph.instances[*instance];
      state.edges.push_back({Kind::kMove, {}, i.text, i.duration, to});
    };
    switch (node.kind) {
      case FlowKind::kSend:
        state.edges.push_back({Kind::kSend, node.peer, node.act->label.text, {}, node.next.index() + 1});
        break;
      case FlowKind::kReceive:
        for (const FlowCase& c : node.cases)
          state.edges.push_back({Kind::kReceive, c.peer, c.source->label.text, {}, c.next.index() + 1});
        if (!node.act->motion.motion.text.empty()) move(machine.states.size());
        break;
      case FlowKind::kMove:
        move(node.next.index() + 1);
        break;
      case FlowKind::kIf:
        state.edges.push_back({Kind::kChoose, {}, "", {}, node.next.index() + 1});
        state.edges.push_back({Kind::kChoose, {}, "", {}, node.otherwise.index() + 1});
        break;
      case FlowKind::kAssign:
        state.edges.push_back({Kind::kChoose, {}, "", {}, node.next.index() + 1});
        break;
      case FlowKind::kExit:
        state.ends = true;
        break;
    }
    machine.states.push_back(std::move(state));
  }
  return machine;
}

}  // namespace rondo::choreo
