#include "choreo/node/process_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "choreo/process/labels.h"

namespace rondo::choreo {

using robot::Value;
using robot::ValueKind;
using runtime::sessions::Step;

namespace {

Step Fault(std::string why) {
  Step step;
  step.kind = Step::Kind::kFault;
  step.label = std::move(why);
  return step;
}

// The value with numbers for its terms.
Value Known(expr::Arena& arena, Value value, std::span<const double> numbers) {
  for (size_t i = 0; i < value.terms.size(); ++i) {
    const bool formula = arena.sort_of(value.terms[i]) == arena.Bool();
    value.terms[i] = formula ? arena.Constant(numbers[i] != 0)
                             : arena.Number(arena.Real(), expr::Rational::FromDouble(numbers[i]));
  }
  value.squared.reset();
  return value;
}

}  // namespace

ProcessScript::ProcessScript(Graph& graph, const Flow& flow, Declarations& declarations, Senses& senses)
    : graph_(graph),
      flow_(flow),
      evaluator_(declarations.evaluator()),
      senses_(senses),
      calls_(graph, declarations, flow.source->loose_names),
      at_(flow.start) {}

robot::Scope ProcessScript::ScopeOf(const FlowNode& node) const {
  robot::Scope scope;
  scope.outer = &graph_.BodyOf(flow_.robot).scope;
  scope.names = locals_;
  for (const Case* c : node.bindings) {
    const auto it = bindings_.find(c);
    for (size_t i = 0; it != bindings_.end() && i < c->names.size() && i < it->second.size(); ++i)
      scope.names[c->names[i].text] = it->second[i];
  }
  return scope;
}

std::optional<std::vector<Value>> ProcessScript::Values(const std::vector<ExprId>& exprs,
                                                        const FlowNode& node) {
  const robot::Scope scope = ScopeOf(node);
  std::vector<Value> values;
  for (const ExprId e : exprs) {
    Value value = evaluator_.Evaluate(e, scope);
    const auto numbers = ValuesOf(evaluator_.arena(), {value}, senses_.Now());
    if (!numbers || value.kind == ValueKind::kError) return std::nullopt;
    values.push_back(Known(evaluator_.arena(), std::move(value), *numbers));
  }
  return values;
}

std::optional<size_t> ProcessScript::Motion(const FlowNode& node) {
  return calls_.Resolve(flow_.robot, node.act->motion, ScopeOf(node));
}

// Goes through what nobody else sees. Returns a step only if that cannot be done.
std::optional<Step> ProcessScript::Silent(const FlowNode& node) {
  if (node.kind == FlowKind::kIf) {
    const expr::TermId guard = evaluator_.Formula(node.act->guard, ScopeOf(node), "a formula");
    at_ = expr::Numeric(evaluator_.arena(), senses_.Now()).Violation(guard) == 0 ? node.next : node.otherwise;
    return std::nullopt;
  }
  auto values = Values({node.act->guard}, node);
  if (!values) return Fault(fmt::format("what is assigned to `{}` has no value", node.act->variable.text));
  locals_[node.act->variable.text] = std::move(values->front());
  at_ = node.next;
  return std::nullopt;
}

// As the choreography calls it.
std::string ProcessScript::LabelOf(RobotId from, RobotId to, const std::string& given) const {
  for (const Node& node : graph_.nodes) {
    if (node.kind == NodeKind::kMessage && node.from == from && node.to == to &&
        SameLabel(node.label, given, flow_.source->loose_names))
      return node.label;
  }
  return given;
}

Step ProcessScript::Next() {
  while (flow_[at_].kind == FlowKind::kIf || flow_[at_].kind == FlowKind::kAssign) {
    if (auto fault = Silent(flow_[at_])) return *fault;
  }
  const FlowNode& node = flow_[at_];
  Step step;
  switch (node.kind) {
    case FlowKind::kSend: {
      step.kind = Step::Kind::kSend;
      step.to = node.peer.value;
      step.label = LabelOf(flow_.robot, node.peer, node.act->label.text);
      const auto values = Values(node.act->values, node);
      const auto numbers = values ? ValuesOf(evaluator_.arena(), *values, {}) : std::nullopt;
      if (!numbers) return Fault(fmt::format("what `{}` carries has no value", step.label));
      step.values = *numbers;
      return step;
    }
    case FlowKind::kReceive:
      step.kind = Step::Kind::kReceive;
      for (const FlowCase& c : node.cases)
        step.cases.push_back({c.peer.value, LabelOf(c.peer, flow_.robot, c.source->label.text)});
      if (node.act->motion.motion.text.empty()) return step;
      break;
    case FlowKind::kMove:
      step.kind = Step::Kind::kMove;
      break;
    case FlowKind::kIf:
    case FlowKind::kAssign:
    case FlowKind::kExit:
      return step;
  }
  step.motion = Motion(node);
  if (!step.motion) return Fault(fmt::format("`{}` cannot be called", node.act->motion.motion.text));
  return step;
}

bool ProcessScript::Waits() const {
  const FlowNode& node = flow_[at_];
  return node.kind == FlowKind::kMove && flow_[node.next].kind == FlowKind::kReceive;
}

void ProcessScript::Took(size_t which, const std::vector<double>& values) {
  const FlowCase& c = flow_[at_].cases[which];
  const std::string label = LabelOf(c.peer, flow_.robot, c.source->label.text);
  const auto message = std::ranges::find_if(graph_.nodes, [&](const Node& n) {
    return n.kind == NodeKind::kMessage && n.from == c.peer && n.to == flow_.robot && n.label == label;
  });
  std::vector<Value> bound;
  size_t at = 0;
  for (const Value& value : message == graph_.nodes.end() ? std::vector<Value>{} : message->payload) {
    if (at + value.terms.size() > values.size()) break;
    bound.push_back(Known(evaluator_.arena(), value, std::span(values).subspan(at, value.terms.size())));
    at += value.terms.size();
  }
  bindings_[c.source] = std::move(bound);
  at_ = c.next;
}

}  // namespace rondo::choreo
