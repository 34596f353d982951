#include "robot/model/body.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::robot {

using diag::Kind;
using lang::Dimension;

namespace {

std::optional<Dimension> DimensionOf(const Name& name, Evaluator& e) {
  if (const Dimension* d = lang::FindDimension(name.text)) return *d;
  e.diagnostics()
      .Report(Kind::kChoreoUndeclared, name.span, fmt::format("there is no dimension `{}`", name.text))
      .Help("one of `length`, `angle`, `time`, `speed`, `acceleration`, `angular_speed`, `number`");
  return std::nullopt;
}

class Filler {
 public:
  Filler(const RobotDef& type, const Arguments& given, Body& body, Evaluator& evaluator)
      : type_(type), given_(given), body_(body), e_(evaluator), arena_(evaluator.arena()) {}

  void Run(TermId clock) {
    body_.type = &type_;
    body_.scope.names.emplace("self", FrameAt(body_.self));
    body_.scope.names.emplace("clock", Quantity(clock, kTime));
    for (const RobotItem& item : type_.items) {
      if (const auto* group = std::get_if<ParamGroup>(&item)) Parameters(*group);
      if (const auto* group = std::get_if<StateGroup>(&item)) Variables(*group);
      if (const auto* frame = std::get_if<FrameDef>(&item)) Frame(*frame);
      if (const auto* shape = std::get_if<ShapeDef>(&item)) Occupies(*shape);
    }
    body_.derivatives.resize(body_.states.size());
    for (const RobotItem& item : type_.items) {
      if (const auto* dynamics = std::get_if<DynamicsDef>(&item)) Dynamics(*dynamics);
      if (const auto* control = std::get_if<ControlDef>(&item)) {
        if (body_.control) {
          e_.diagnostics().Report(Kind::kChoreoDuplicate, control->span,
                                  fmt::format("`{}` has two controllers", type_.name.text));
        }
        body_.control = ReadControl(body_, *control, body_.scope, e_);
      }
    }
    for (const RobotItem& item : type_.items) {
      const auto* port = std::get_if<PortDef>(&item);
      if (port == nullptr) continue;
      Value value = e_.Evaluate(port->value, body_.scope);
      if (!body_.ports.emplace(port->name.text, std::move(value)).second) {
        e_.diagnostics().Report(Kind::kChoreoDuplicate, port->name.span,
                                fmt::format("`{}` is declared twice", port->name.text));
      }
    }
    for (const Variable& v : body_.states) body_.sensed.insert(v.term);
    for (const Variable& v : body_.inputs) body_.sensed.insert(v.term);
    for (const Variable& v : body_.memory) body_.sensed.insert(v.term);
  }

 private:
  void Claim(const Name& name, Value value) {
    if (body_.scope.names.emplace(name.text, std::move(value)).second) return;
    e_.diagnostics().Report(Kind::kChoreoDuplicate, name.span,
                            fmt::format("`{}` is declared twice", name.text));
  }

  void Parameters(const ParamGroup& group) {
    for (const Param& p : group.params) {
      const auto it = given_.find(p.name.text);
      Value value = it != given_.end() ? it->second.first
                    : p.value.valid()  ? e_.Evaluate(p.value, body_.scope)
                                       : Value{};
      if (it == given_.end() && !p.value.valid()) {
        e_.diagnostics()
            .Report(Kind::kChoreoArity, body_.name.span,
                    fmt::format("`{}` needs a value for `{}`", type_.name.text, p.name.text))
            .At(p.name.span, "declared here, without a default");
      }
      if (!p.dimension.text.empty() && value.kind == ValueKind::kQuantity) {
        const auto d = DimensionOf(p.dimension, e_);
        if (d && !value.any_dimension && !(value.dimension == *d)) {
          const diag::Span span = it != given_.end() ? it->second.second : e_.SpanOf(p.value);
          value =
              e_.WrongUnit(span, value, fmt::format("{} for `{}`", Describe(Quantity({}, *d)), p.name.text));
        } else if (d) {
          value = Quantity(value.terms[0], *d);
        }
      }
      if (e_.loose() != nullptr && e_.loose()->name == p.name.text && value.kind == ValueKind::kQuantity)
        value = Unknown(p.name, value.dimension, *e_.loose());
      Claim(p.name, std::move(value));
    }
  }

  // A parameter that has a range instead of a value.
  Value Unknown(const Name& name, Dimension dimension, const Loose& range) {
    const TermId term =
        arena_.Variable(arena_.Declare(fmt::format("{}.{}", body_.name.text, name.text), {}, arena_.Real()));
    body_.unknowns.push_back({name, dimension, term, arena_.Number(arena_.Real(), range.least),
                              arena_.Number(arena_.Real(), range.most)});
    return Quantity(term, dimension);
  }

  void Variables(const StateGroup& group) {
    const bool input = group.keyword.text == "input";
    for (Variable& v : DeclareVariables(group, body_.name.text, body_.scope, e_)) {
      const auto it = given_.find(v.name.text);
      if (input && it != given_.end()) {
        Input(v, it->second.first, it->second.second);
        continue;
      }
      Claim(v.name, Quantity(v.term, v.dimension));
      auto& list = input ? body_.inputs : group.keyword.text == "memory" ? body_.memory : body_.states;
      list.push_back(std::move(v));
    }
  }

  // What the world says that an input is.
  void Input(const Variable& v, Value value, diag::Span span) {
    if (value.kind == ValueKind::kQuantity && !value.any_dimension && !(value.dimension == v.dimension)) {
      value = e_.WrongUnit(span, value,
                           fmt::format("{} for `{}`", Describe(Quantity({}, v.dimension)), v.name.text));
    } else if (value.kind != ValueKind::kQuantity) {
      value = e_.WrongType(span, value, "a quantity");
    }
    body_.sensed.merge(VariablesOf(arena_, value.terms));
    Claim(v.name, std::move(value));
  }

  void Frame(const FrameDef& def) {
    const Value v = e_.Evaluate(def.value, body_.scope);
    if (v.kind != ValueKind::kFrame) {
      e_.WrongType(e_.SpanOf(def.value), v, "a frame: `self * translate(...) * rotate_z(...)`");
    } else if (def.keyword.text == "mount") {
      body_.mounts.emplace(def.name.text, *v.pose);
    }
    Claim(def.name, v);
  }

  void Occupies(const ShapeDef& def) {
    auto shape = e_.ShapeAt(def.value, body_.scope, "a shape");
    if (!shape) return;
    std::optional<Shape>& slot = def.keyword.text == "body" ? body_.body : body_.hull;
    slot = shape;
    Claim(def.keyword, ShapeOf(std::move(*shape)));
  }

  void Dynamics(const DynamicsDef& def) {
    for (const Derivative& d : def.derivatives) {
      size_t i = 0;
      while (i < body_.states.size() && body_.states[i].name.text != d.variable.text) ++i;
      if (i == body_.states.size()) {
        e_.diagnostics().Report(Kind::kChoreoUndeclared, d.variable.span,
                                fmt::format("`{}` has no state `{}`", type_.name.text, d.variable.text));
        continue;
      }
      Dimension rate = body_.states[i].dimension;
      --rate.time;
      body_.derivatives[i] =
          e_.Measure(d.value, body_.scope, rate,
                     fmt::format("the rate of `{}`, in {},", d.variable.text, UnitText(rate)));
    }
  }

  const RobotDef& type_;
  const Arguments& given_;
  Body& body_;
  Evaluator& e_;
  Arena& arena_;
};

}  // namespace

std::vector<Variable> DeclareVariables(const StateGroup& group, const std::string& owner, const Scope& scope,
                                       Evaluator& e) {
  std::vector<Variable> variables;
  const auto dimension = DimensionOf(group.dimension, e);
  if (!dimension) return variables;
  std::optional<TermId> least, most;
  const std::string what = fmt::format("a bound in {}", UnitText(*dimension));
  if (group.least.valid()) least = e.Measure(group.least, scope, *dimension, what);
  if (group.most.valid()) most = e.Measure(group.most, scope, *dimension, what);
  if (least && most && e.arena().Le(*least, *most) == e.arena().False())
    e.diagnostics().Report(Kind::kRobotRange, group.span, "no value lies in this range");
  for (const Name& name : group.names) {
    const expr::SymbolId symbol =
        e.arena().Declare(fmt::format("{}.{}", owner, name.text), {}, e.arena().Real());
    variables.push_back({name, *dimension, e.arena().Variable(symbol), least, most});
  }
  return variables;
}

bool HasParameter(const RobotDef& type, std::string_view name) {
  for (const RobotItem& item : type.items) {
    if (const auto* group = std::get_if<ParamGroup>(&item)) {
      for (const Param& p : group->params) {
        if (p.name.text == name) return true;
      }
    }
    const auto* group = std::get_if<StateGroup>(&item);
    if (group == nullptr || group->keyword.text != "input") continue;
    for (const Name& n : group->names) {
      if (n.text == name) return true;
    }
  }
  return false;
}

namespace {

// `x = ...` for some of these variables, each at most once.
void ReadLaws(const Body& body, const std::vector<Derivative>& laws,
              std::initializer_list<const std::vector<Variable>*> lists, const Scope& scope, Evaluator& e,
              std::vector<std::pair<TermId, TermId>>& out) {
  const bool inputs = lists.size() > 1;
  for (const Derivative& law : laws) {
    const Variable* variable = nullptr;
    for (const auto* list : lists) {
      for (const Variable& v : *list) {
        if (v.name.text == law.variable.text) variable = &v;
      }
    }
    if (variable == nullptr) {
      e.diagnostics()
          .Report(Kind::kChoreoUndeclared, law.variable.span,
                  fmt::format("`{}` has no {}memory `{}`", body.type->name.text,
                              inputs ? "input and no " : "", law.variable.text))
          .Help(inputs ? "a controller sets inputs and memory; states follow `dynamics`"
                       : "an event sets memory; inputs are set by laws, which may depend on it");
      continue;
    }
    for (const auto& [known, value] : out) {
      if (known == variable->term)
        e.diagnostics().Report(Kind::kChoreoDuplicate, law.variable.span,
                               fmt::format("`{}` is set twice", law.variable.text));
    }
    const auto value =
        e.Measure(law.value, scope, variable->dimension,
                  fmt::format("`{}`, in {},", law.variable.text, UnitText(variable->dimension)));
    if (value) out.emplace_back(variable->term, *value);
  }
}

}  // namespace

Control ReadControl(const Body& body, const ControlDef& def, const Scope& scope, Evaluator& e) {
  Control control;
  if (def.period.valid()) {
    control.period = e.Measure(def.period, scope, kTime, "a period");
    if (control.period && e.arena().IsNumber(*control.period) &&
        !(e.arena().number(*control.period) > expr::Rational(0))) {
      e.diagnostics().Report(Kind::kRobotRange, e.SpanOf(def.period), "a period is longer than nothing");
    } else if (control.period && !e.arena().IsNumber(*control.period)) {
      e.diagnostics().Report(Kind::kRobotType, e.SpanOf(def.period), "a period is a constant");
    }
  }
  ReadLaws(body, def.laws, {&body.inputs, &body.memory}, scope, e, control.laws);
  for (const WhenDef& when : def.events) {
    ControlEvent event;
    event.condition = e.Formula(when.condition, scope, "a condition");
    ReadLaws(body, when.updates, {&body.memory}, scope, e, event.updates);
    control.events.push_back(std::move(event));
  }
  return control;
}

void FillBody(const RobotDef& type, const Arguments& given, TermId clock, Body& body, Evaluator& evaluator) {
  Filler(type, given, body, evaluator).Run(clock);
}

std::optional<std::string> UnknownTo(const Body& body, const Arena& arena, const std::vector<TermId>& terms,
                                     const std::vector<TermId>& told) {
  for (const TermId t : VariablesOf(arena, terms)) {
    if (body.sensed.contains(t) || std::ranges::find(told, t) != told.end()) continue;
    return arena.symbol(arena.symbol_of(t)).name;
  }
  return std::nullopt;
}

Value SeenFromOutside(const Body& body) {
  Members members;
  for (const auto& [name, value] : body.scope.names) {
    if (name != "self" && name != "clock") members.emplace(name, value);
  }
  Value value;
  value.kind = ValueKind::kComponent;
  value.members = std::make_shared<const Members>(std::move(members));
  return value;
}

}  // namespace rondo::robot
