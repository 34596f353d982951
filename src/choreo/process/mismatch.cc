#include "choreo/process/mismatch.h"

#include <fmt/format.h>

namespace rondo::choreo {

using diag::Kind;

Mismatch::Mismatch(const Flow& flow, const Graph& graph, const LocalType& type,
                   diag::Diagnostics& diagnostics)
    : flow_(flow), graph_(graph), type_(type), diagnostics_(diagnostics) {}

bool Mismatch::Report(const std::function<void()>& report) const {
  if (trying == 0) report();
  return false;
}

std::string Mismatch::Asked(StateId s) const {
  const LocalState& state = type_.states[s.index()];
  if (state.ends) return "the choreography ends here";
  if (!state.choice.empty()) return fmt::format("`{}` chooses here", graph_.NameOf(type_.robot));
  std::string text;
  for (const auto& [action, to] : state.next) {
    text += text.empty() ? "" : ", or ";
    switch (action.kind) {
      case Action::Kind::kSend:
        text += fmt::format("`{}` is sent to `{}`", action.label, graph_.NameOf(action.peer));
        break;
      case Action::Kind::kReceive:
        text += fmt::format("`{}` comes from `{}`", action.label, graph_.NameOf(action.peer));
        break;
      case Action::Kind::kMove:
        text += fmt::format("the motion is `{}`", action.label);
        break;
    }
  }
  return "in the choreography, " + text;
}

void Mismatch::AtNodes(diag::Diagnostic& report, StateId s) const {
  for (const auto& [action, nodes] : type_.states[s.index()].nodes)
    report.At(graph_[nodes[0]].span, "this is what comes next");
}

diag::Span Mismatch::FirstNode(StateId s, const Action& action) const {
  return graph_[type_.states[s.index()].nodes.at(action)[0]].span;
}

bool Mismatch::Step(FlowId p, StateId s, std::string_view does) const {
  return Report([&] {
    auto& report = diagnostics_.Report(
        Kind::kProcessStep, flow_[p].span,
        fmt::format("`{}` {} here, which the choreography does not allow", graph_.NameOf(type_.robot), does));
    AtNodes(report, s);
    report.Note(Asked(s));
  });
}

bool Mismatch::Peer(FlowId p, StateId s, const Action& asked) const {
  return Report([&] {
    const FlowNode& node = flow_[p];
    auto& report = diagnostics_.Report(Kind::kProcessPeer, node.act->peer.span,
                                       fmt::format("`{}` is for `{}`, not for `{}`", asked.label,
                                                   graph_.NameOf(asked.peer), graph_.NameOf(node.peer)));
    AtNodes(report, s);
  });
}

bool Mismatch::Label(FlowId p, StateId s, const Action& asked) const {
  return Report([&] {
    const FlowNode& node = flow_[p];
    auto& report = diagnostics_.Report(Kind::kProcessLabel, node.act->label.span,
                                       fmt::format("`{}` expects `{}`, not `{}`", graph_.NameOf(node.peer),
                                                   asked.label, node.act->label.text));
    AtNodes(report, s);
  });
}

bool Mismatch::Waits(FlowId p, StateId s, const Action& motion) const {
  return Report([&] {
    auto& report = diagnostics_.Report(Kind::kProcessMotion, flow_[p].span,
                                       fmt::format("`{}` waits here, but the choreography asks it for `{}`",
                                                   graph_.NameOf(type_.robot), motion.label));
    AtNodes(report, s);
    report.Help(fmt::format("write `receive from ... while {}`", motion.label));
  });
}

bool Mismatch::NoCase(FlowId p, StateId s, const Action& message, const FlowCase* other) const {
  return Report([&] {
    const std::string& sender = graph_.NameOf(message.peer);
    if (other != nullptr) {
      diagnostics_
          .Report(Kind::kProcessPeer, other->source->peer.span,
                  fmt::format("`{}` comes from `{}`, not from `{}`", message.label, sender,
                              other->source->peer.text))
          .At(FirstNode(s, message), "the message");
      return;
    }
    diagnostics_
        .Report(Kind::kProcessCase, flow_[p].span,
                fmt::format("there is no case for `{}` from `{}`", message.label, sender))
        .At(FirstNode(s, message), "this message may come");
  });
}

bool Mismatch::NobodyListens(FlowId p, StateId s, const Action& message) const {
  return Report([&] {
    const std::string& sender = graph_.NameOf(message.peer);
    diagnostics_
        .Report(Kind::kProcessCase, flow_[p].span,
                fmt::format("`{}` from `{}` may come here, and nobody listens", message.label, sender))
        .At(FirstNode(s, message), "this message")
        .Help(fmt::format("write `receive from {} while {}() {{ {} => ... }}`", sender,
                          flow_[p].act->motion.motion.text, message.label));
  });
}

bool Mismatch::NoAlternative(FlowId way, StateId s) const {
  return Report([&] {
    const LocalState& state = type_.states[s.index()];
    auto& report = diagnostics_.Report(Kind::kProcessGuard, flow_[way].span,
                                       "no alternative of the choreography goes on like this");
    report.At(graph_[state.chosen].span, "the choice");
    for (const auto& [guard, to] : state.choice) report.Note(Asked(to));
  });
}

bool Mismatch::NeverOffered(FlowId chooses, FlowId way, StateId s) const {
  return Report([&] {
    diagnostics_
        .Report(Kind::kProcessGuard, flow_[way].span, "the choreography never offers this alternative here")
        .At(flow_[chooses].span, "the process chooses here")
        .At(graph_[type_.states[s.index()].chosen].span, "the choice in the choreography");
  });
}

}  // namespace rondo::choreo
