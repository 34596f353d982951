#include "choreo/node/projection_script.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::choreo {

using runtime::sessions::Step;

namespace {

size_t InstanceOf(const Node& motion, RobotId robot) {
  return std::ranges::find(motion.parts, robot, &Part::robot)->instance;
}

}  // namespace

// Goes through choices until something is to be done. False if no alternative holds.
bool ProjectionScript::Choose(std::string& problem) {
  // Choices follow one another without a step only as often as there are states: loops of them are not well-formed.
  for (size_t i = 0; i <= type_.states.size() && !At(at_).choice.empty(); ++i) {
    const LocalState& state = At(at_);
    const Node& node = graph_[state.chosen];
    expr::Numeric numeric(arena_, senses_.Now());
    std::vector<StateId> possible;
    for (const double slack : {0.0, kRounding}) {
      for (size_t b = 0; b < state.choice.size() && (slack == 0 || possible.empty()); ++b) {
        if (numeric.Violation(node.guard_terms[b]) <= slack) possible.push_back(state.choice[b].second);
      }
    }
    if (possible.empty()) {
      problem = "no alternative of its choice holds";
      return false;
    }
    at_ = possible[possible.size() == 1 ? 0 : senses_.Pick(possible.size())];
  }
  return true;
}

Step ProjectionScript::Next() {
  Step step;
  cases_.clear();
  if (!Choose(step.label)) {
    step.kind = Step::Kind::kFault;
    return step;
  }
  const LocalState& state = At(at_);
  for (const auto& [action, to] : state.next) {
    const Node& node = graph_[state.nodes.at(action)[0]];
    switch (action.kind) {
      case Action::Kind::kSend: {
        step.kind = Step::Kind::kSend;
        step.to = action.peer.value;
        step.label = action.label;
        only_ = to;
        const bool chosen = std::ranges::any_of(node.names, [](const std::string& n) { return !n.empty(); });
        const auto values = chosen ? senses_.Choose(node) : ValuesOf(arena_, node.payload, senses_.Now());
        if (values) {
          step.values = *values;
          return step;
        }
        step.kind = Step::Kind::kFault;
        step.label = fmt::format("there is no value that `{}` may carry", action.label);
        return step;
      }
      case Action::Kind::kReceive:
        step.kind = Step::Kind::kReceive;
        step.cases.push_back({action.peer.value, action.label});
        cases_.push_back(to);
        break;
      case Action::Kind::kMove:
        step.motion = InstanceOf(node, type_.robot);
        only_ = to;
        break;
    }
  }
  if (step.kind == Step::Kind::kEnd && step.motion) step.kind = Step::Kind::kMove;
  if (step.kind == Step::Kind::kReceive && step.motion) Behind(step);
  return step;
}

// Whoever listens and may move begins to move, and listens on: for what comes instead of the motion, at once, and for what
// comes behind it, also behind further motions if these may be over as they begin. These messages are different ones: else
// there is no projection.
void ProjectionScript::Behind(Step& step) {
  step.again = false;
  StateId at = only_;
  for (size_t i = 0; i < type_.states.size(); ++i) {
    const LocalState& state = At(at);
    step.ends = step.ends || state.ends;
    std::optional<StateId> next;
    for (const auto& [action, to] : state.next) {
      if (action.kind == Action::Kind::kReceive) {
        step.cases.push_back({action.peer.value, action.label});
        cases_.push_back(to);
      }
      if (action.kind != Action::Kind::kMove) continue;
      const Node& node = graph_[state.nodes.at(action)[0]];
      const Duration& d = std::ranges::find(node.parts, type_.robot, &Part::robot)->duration;
      if (d.interruptible && d.least.IsZero()) next = to;
    }
    if (!next) return;
    at = *next;
  }
}

bool ProjectionScript::Waits() const {
  const LocalState& state = At(only_);
  return state.choice.empty() &&
         std::ranges::none_of(state.next,
                              [](const auto& n) { return n.first.kind == Action::Kind::kSend; }) &&
         std::ranges::any_of(state.next,
                             [](const auto& n) { return n.first.kind == Action::Kind::kReceive; });
}

void ProjectionScript::Took(size_t which, const std::vector<double>&) { at_ = cases_[which]; }

}  // namespace rondo::choreo
