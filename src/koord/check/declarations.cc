#include <fmt/format.h>

#include <algorithm>

#include "expr/rational.h"
#include "koord/check/checker.h"
#include "lang/expr_printer.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;

Model Check(const Program& program, diag::Diagnostics& diagnostics) {
  return Checker(program, diagnostics).Run();
}

Model Checker::Run() {
  model_.program = &program_;
  model_.type_of.assign(exprs_.size(), model_.types.error());
  model_.ref_of.assign(exprs_.size(), Ref{});
  CheckOrder();
  DeclareTypes();
  DeclareAll();
  place_ = Place::kInit;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].initial.valid()) InitialValue(v);
  }
  for (size_t f = 0; f < model_.functions.size(); ++f) {
    const FunctionDef* def = model_.functions[f].def;
    if (def == nullptr || !def->has_body) continue;
    place_ = Place::kFunction;
    function_ = static_cast<int>(f);
    std::vector<uint32_t> bindings;
    for (size_t i = 0; i < def->parameters.size(); ++i) {
      bindings.push_back(
          Bind(def->parameters[i].name, model_.functions[f].parameters[i], def->parameters[i].span));
    }
    model_.bound_by[def] = bindings;
    Body(def->body);
    scope_.clear();
  }
  function_ = -1;
  place_ = Place::kInit;
  may_choose_ = true;
  for (const InitDef* init : model_.inits) Body(init->body);
  place_ = Place::kEvent;
  for (const EventDef* event : model_.events) {
    may_choose_ = false;
    if (event->pre.valid()) NeedBool(event->pre, "a precondition");
    may_choose_ = true;
    Body(event->body);
  }
  may_choose_ = false;
  for (const FallbackDef* fallback : model_.fallbacks) CheckFallback(*fallback);
  Specifications();
  CheckRecursion();
  CheckSignatures();
  if (model_.events.empty() && !diagnostics_.has_errors()) {
    diagnostics_
        .Report(Kind::kKoordNoEvent, program_.item_spans.empty() ? Span{} : program_.item_spans.back(),
                "a program needs at least one event")
        .Help("an event has a name, a precondition `pre:` and an effect `eff:`");
  }
  return std::move(model_);
}

// Of an array: a list of its items, or what all of them are.
void Checker::InitialValue(size_t variable) {
  const Variable v = model_.variables[variable];
  TypeId type = v.type;
  const bool array = model_.types.Is(type, lang::TypeKind::kArray);
  if (array && !IsArrayLiteral(v.initial, type) && exprs_[v.initial].kind != lang::ExprKind::kName) {
    while (model_.types.Is(type, lang::TypeKind::kArray)) type = model_.types[type].parts[0];
    model_.filled.insert(variable);
  }
  NeedType(v.initial, type, fmt::format("the initial value of `{}`", v.name));
  RestrictInitial(v.initial, v);
}

void Checker::CheckOrder() {
  constexpr const char* kNames[] = {
      "the name of the program", "definitions", "modules", "variables", "`init`", "events", "fallbacks"};
  struct Rank {
    int operator()(const AgentHeader&) const { return 0; }
    int operator()(const FunctionDef&) const { return 1; }
    int operator()(const AdtDef&) const { return 1; }
    int operator()(const EnumDef&) const { return 1; }
    int operator()(const ModuleDef&) const { return 2; }
    int operator()(const Section&) const { return 3; }
    int operator()(const InitDef&) const { return 4; }
    int operator()(const EventDef&) const { return 5; }
    int operator()(const FallbackDef&) const { return 6; }
    int operator()(const ParamDef&) const { return -1; }
    int operator()(const AssumeDef&) const { return -1; }
    int operator()(const SummaryDef&) const { return -1; }
    int operator()(const InvariantDef&) const { return -1; }
    int operator()(const ResponseDef&) const { return -1; }
    int operator()(const ExploreDef&) const { return -1; }
    int operator()(const PlatformDef&) const { return -1; }
  };
  int highest = 0;
  Span highest_span;
  for (size_t i = 0; i < program_.items.size(); ++i) {
    const int rank = std::visit(Rank{}, program_.items[i]);
    if (rank < 0) continue;
    if (rank < highest) {
      // A specification brings its own functions, often in a file of its own.
      if (std::holds_alternative<FunctionDef>(program_.items[i])) continue;
      diagnostics_
          .Report(Kind::kKoordSectionOrder, program_.item_spans[i],
                  fmt::format("{} after {}", kNames[rank], kNames[highest]))
          .At(highest_span, "this comes last by convention")
          .Help("the usual order: definitions, modules, variables, `init`, events, fallbacks, specification");
      return;
    }
    if (rank > highest) highest_span = program_.item_spans[i];
    highest = rank;
  }
}

bool Checker::Claim(const std::string& name, Span span) {
  const auto [it, fresh] = claimed_.emplace(name, span);
  if (!fresh) {
    diagnostics_.Report(Kind::kKoordDuplicate, span, fmt::format("`{}` is declared twice", name))
        .At(it->second, "first declared here");
  }
  return fresh;
}

void Checker::DeclareTypes() {
  auto& types = model_.types;
  for (const Item& item : program_.items) {
    if (const auto* def = std::get_if<EnumDef>(&item)) {
      if (!Claim(def->name, def->span)) continue;
      const TypeId type = types.Enum(def->name, def->members);
      model_.named_types[def->name] = type;
      for (uint32_t i = 0; i < def->members.size(); ++i) {
        if (Claim(def->members[i], def->member_spans[i])) enum_members_[def->members[i]] = {type, i};
      }
    } else if (const auto* adt = std::get_if<AdtDef>(&item)) {
      if (Claim(adt->name, adt->span)) model_.named_types[adt->name] = types.Record(adt->name, {}, {});
    }
  }
  std::set<std::string> done;
  for (const Item& item : program_.items) {
    const auto* adt = std::get_if<AdtDef>(&item);
    if (adt == nullptr || !done.insert(adt->name).second) continue;
    std::vector<std::string> fields;
    std::vector<TypeId> parts;
    for (const Decl& field : adt->fields) {
      if (std::find(fields.begin(), fields.end(), field.name) != fields.end()) {
        diagnostics_.Report(Kind::kKoordDuplicate, field.span,
                            fmt::format("`{}` is declared twice", field.name));
        continue;
      }
      TypeId type = TypeOf(field);
      if (type == model_.named_types[adt->name]) {
        Mismatch(field.span, fmt::format("`{}` cannot contain itself", adt->name));
        type = types.error();
      }
      fields.push_back(field.name);
      parts.push_back(type);
    }
    if (fields.empty()) {
      fields.push_back("nothing");
      parts.push_back(types.boolean());
    }
    types.SetFields(model_.named_types[adt->name], std::move(fields), std::move(parts));
  }
}

void Checker::DeclareAll() {
  for (const Item& item : program_.items) {
    if (const auto* module = std::get_if<ModuleDef>(&item)) DeclareModule(*module);
    if (const auto* section = std::get_if<Section>(&item)) {
      constexpr VariableKind kKinds[] = {VariableKind::kAllread, VariableKind::kAllwrite,
                                         VariableKind::kLocal};
      for (const Decl& d : section->decls) DeclareVariable(kKinds[static_cast<size_t>(section->kind)], "", d);
    }
    if (const auto* param = std::get_if<ParamDef>(&item))
      DeclareVariable(VariableKind::kParam, "", param->decl);
    if (const auto* function = std::get_if<FunctionDef>(&item)) DeclareFunction(*function);
    if (const auto* init = std::get_if<InitDef>(&item)) model_.inits.push_back(init);
    if (const auto* event = std::get_if<EventDef>(&item)) {
      // Events have a name space of their own: the original programs call an event and a variable alike.
      if (Claim("event " + event->name, event->span)) model_.events.push_back(event);
    }
    if (const auto* def = std::get_if<FallbackDef>(&item)) {
      if (Claim(def->code.name, def->span)) model_.fallbacks.push_back(def);
    }
    if (const auto* def = std::get_if<AssumeDef>(&item)) model_.assumptions.push_back(def);
    if (const auto* def = std::get_if<SummaryDef>(&item)) model_.summaries.push_back(def);
    if (const auto* def = std::get_if<ExploreDef>(&item)) explorations_.push_back(def);
    if (const auto* def = std::get_if<PlatformDef>(&item)) model_.platforms.push_back(def);
    if (const auto* def = std::get_if<ResponseDef>(&item)) {
      if (Claim("response " + def->name, def->span)) model_.responses.push_back(def);
    }
    if (const auto* def = std::get_if<InvariantDef>(&item)) {
      if (def->name.empty() || Claim("invariant " + def->name, def->span)) model_.invariants.push_back(def);
    }
  }
}

void Checker::DeclareModule(const ModuleDef& module) {
  if (!Claim(module.name, module.span)) return;
  modules_.insert(module.name);
  for (const PortGroup& group : module.groups) {
    for (const Decl& port : group.ports) {
      DeclareVariable(group.sensors ? VariableKind::kSensor : VariableKind::kActuator, module.name, port);
    }
  }
}

void Checker::DeclareVariable(VariableKind kind, const std::string& module, const Decl& decl) {
  const std::string name = module.empty() ? decl.name : fmt::format("{}.{}", module, decl.name);
  if (!Claim(name, decl.span)) return;
  Variable variable{kind, name, module, {}, decl.span, decl.initial, -1};
  Decl shape = decl;
  if (kind == VariableKind::kAllread) {
    // `T x[N_sys]`, `T[] x` and `T x` are one cell for each robot.
    if (!shape.dimensions.empty())
      shape.dimensions.erase(shape.dimensions.begin());
    else if (!shape.type.dimensions.empty())
      shape.type.dimensions.erase(shape.type.dimensions.begin());
  }
  if (!decl.members.empty()) {
    const std::string type_name = "enum of " + name;
    variable.type = model_.types.Enum(type_name, decl.members);
    for (uint32_t i = 0; i < decl.members.size(); ++i) {
      if (Claim(decl.members[i], decl.span)) enum_members_[decl.members[i]] = {variable.type, i};
    }
  } else {
    variable.type = TypeOf(shape);
  }
  if (kind == VariableKind::kSensor && decl.type.name == "PathPlanner" && !claimed_.contains("PathPlanner")) {
    Function function{name, {}, {}, {}, nullptr, false, decl.span, static_cast<int>(model_.variables.size())};
    variable.function = static_cast<int>(model_.functions.size());
    model_.functions.push_back(std::move(function));
  }
  if (decl.type.name == "Queue" || decl.type.name == "queue") queues_.insert(model_.variables.size());
  model_.variables.push_back(std::move(variable));
}

void Checker::DeclareFunction(const FunctionDef& def) {
  if (!Claim(def.name, def.span)) return;
  Function function{def.name, {}, {}, {}, &def, true, def.span, -1};
  std::set<std::string> seen;
  for (const Decl& p : def.parameters) {
    if (!seen.insert(p.name).second) {
      diagnostics_.Report(Kind::kKoordDuplicate, p.span, fmt::format("`{}` is declared twice", p.name));
    }
    function.parameter_names.push_back(p.name);
    function.parameters.push_back(p.type.name == "type" ? model_.types.FreshVariable() : TypeOf(p));
  }
  function.result = def.result.name.empty() ? model_.types.FreshVariable() : TypeOf(def.result);
  model_.functions.push_back(std::move(function));
}

TypeId Checker::TypeOf(const Decl& decl) { return WithDimensions(TypeOf(decl.type), decl.dimensions); }

TypeId Checker::WithDimensions(TypeId base, const std::vector<ExprId>& dimensions) {
  TypeId type = base;
  for (auto it = dimensions.rbegin(); it != dimensions.rend(); ++it) {
    if (!it->valid()) {
      type = model_.types.List(type);
      continue;
    }
    type = model_.types.Array(type, LengthOf(*it));
  }
  return type;
}

// Made of numbers, parameters and the number of robots?
bool Checker::IsFixed(ExprId id) const {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kVariable) return model_.variables[ref.index].kind == VariableKind::kParam;
  if (ref.kind == RefKind::kSystemSize || e.kind == lang::ExprKind::kInt || e.kind == lang::ExprKind::kError)
    return true;
  const bool arithmetic =
      e.kind == lang::ExprKind::kUnary ||
      (e.kind == lang::ExprKind::kBinary && (e.text == "+" || e.text == "-" || e.text == "*"));
  return arithmetic && std::all_of(e.args.begin(), e.args.end(), [this](ExprId a) { return IsFixed(a); });
}

// Lengths are told apart by their text: a number, the number of robots, or an expression over parameters.
std::string Checker::LengthOf(ExprId length) {
  NeedType(length, model_.types.integer(), "the length of an array");
  if (model_.RefOf(length).kind == RefKind::kSystemSize) return kRobotsLength;
  std::string text = lang::PrintExpr(exprs_, length);
  if (!model_.types.Is(model_.TypeOf(length), lang::TypeKind::kError) && !IsFixed(length)) {
    diagnostics_.Report(Kind::kKoordArrayLength, exprs_[length].span, "the length of an array never changes")
        .Help("use numbers, parameters and `N_sys`, or a list");
  }
  if (const auto number = expr::Rational::Parse(text)) {
    if (*number < expr::Rational(1))
      diagnostics_.Report(Kind::kKoordArrayLength, exprs_[length].span, "an array has at least one item")
          .Help("a list can be empty: `List<int>`");
    text = number->ToString();
  }
  model_.lengths.emplace(text, length);
  return text;
}

TypeId Checker::TypeOf(const lang::TypeSyntax& syntax) {
  auto& types = model_.types;
  std::string lower = syntax.name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  std::vector<TypeId> arguments;
  for (const lang::TypeSyntax& a : syntax.arguments) arguments.push_back(TypeOf(a));
  TypeId type;
  const auto named = model_.named_types.find(syntax.name);
  if (named != model_.named_types.end()) {
    type = named->second;
  } else if (lower == "bool" || lower == "boolean") {
    type = types.boolean();
  } else if (lower == "int" || lower == "integer") {
    type = types.integer();
  } else if (lower == "float" || lower == "real" || lower == "time") {
    type = types.real();
  } else if (lower == "string" || lower == "str" || lower == "char") {
    type = types.string();
  } else if (lower == "stream") {
    type = types.stream();
  } else if (lower == "pos" || lower == "point" || lower == "position" || lower == "itemposition") {
    type = types.pos();
  } else if (lower == "list" || lower == "queue") {
    // Two arguments: a list of pairs.
    if (arguments.empty()) arguments.push_back(types.FreshVariable());
    type = types.List(arguments.size() == 1 ? arguments[0] : types.Tuple(arguments));
  } else if (lower == "map" || lower == "set") {
    std::string name = syntax.name;
    for (size_t i = 0; i < arguments.size(); ++i) name += (i == 0 ? "<" : ", ") + types.Name(arguments[i]);
    type = types.Opaque(arguments.empty() ? name : name + ">");
  } else if (std::isupper(static_cast<unsigned char>(syntax.name[0]))) {
    // Only functions look inside.
    type = model_.named_types[syntax.name] = types.Opaque(syntax.name);
  } else {
    auto& report = diagnostics_.Report(Kind::kKoordUnknownType, syntax.span,
                                       fmt::format("there is no type `{}`", syntax.name));
    std::vector<std::string> known{"int", "float", "bool", "string", "stream", "pos", "List", "Queue"};
    for (const auto& [name, _] : model_.named_types) known.push_back(name);
    if (const std::string near = lang::Suggest(syntax.name, known); !near.empty()) {
      report.Help(fmt::format("did you mean `{}`?", near)).Fix(syntax.span, near);
    }
    type = types.error();
  }
  return WithDimensions(type, syntax.dimensions);
}

}  // namespace rondo::koord
