#include <fmt/format.h>

#include <algorithm>

#include "koord/check/checker.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;
using lang::ExprKind;
using lang::TypeKind;

int Checker::FindVariable(const std::string& name) const {
  for (size_t i = 0; i < model_.variables.size(); ++i) {
    if (model_.variables[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

void Checker::Undeclared(const std::string& name, Span span) {
  auto& report = diagnostics_.Report(Kind::kKoordUndeclared, span, fmt::format("`{}` is not declared", name));
  if (name == "stopped") {
    report.Help("only specifications know who has stopped: `stopped[i]`");
    return;
  }
  std::vector<std::string> known;
  for (const Variable& v : model_.variables) known.push_back(v.name);
  for (const uint32_t b : scope_) known.push_back(model_.bindings[b].name);
  for (const auto& [member, _] : enum_members_) known.push_back(member);
  if (const std::string near = lang::Suggest(name, known); !near.empty()) {
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(span, near);
  }
}

TypeId Checker::Name(ExprId id, const lang::Expr& e) {
  for (auto it = scope_.rbegin(); it != scope_.rend(); ++it) {
    if (model_.bindings[*it].name != e.text) continue;
    Set(id, RefKind::kBinding, *it);
    return model_.bindings[*it].type;
  }
  if (const int v = FindVariable(e.text); v >= 0)
    return ReadVariable(id, static_cast<size_t>(v), RefKind::kVariable);
  if (const auto it = enum_members_.find(e.text); it != enum_members_.end()) {
    Set(id, RefKind::kMember, it->second.second);
    return it->second.first;
  }
  if (e.text == "N_sys" || e.text == "Nsys" || e.text == "numAgents" || e.text == "numBots") {
    Set(id, RefKind::kSystemSize, 0);
    return model_.types.integer();
  }
  // A bare port name means the only port with that name.
  if (const int port = fallback_.empty() ? -1 : FindVariable(fallback_ + "." + e.text); port >= 0)
    return ReadVariable(id, static_cast<size_t>(port), RefKind::kVariable);
  std::vector<size_t> ports;
  for (size_t i = 0; i < model_.variables.size(); ++i) {
    const Variable& v = model_.variables[i];
    if (!v.module.empty() && v.name == v.module + "." + e.text) ports.push_back(i);
  }
  if (ports.size() == 1) return ReadVariable(id, ports[0], RefKind::kVariable);
  if (ports.size() > 1) {
    auto& report = diagnostics_.Report(Kind::kKoordAmbiguousPort, e.span,
                                       fmt::format("`{}` could be more than one port", e.text));
    for (const size_t p : ports)
      report.At(model_.variables[p].span, fmt::format("`{}`", model_.variables[p].name));
    return model_.types.error();
  }
  if (IsModule(e.text)) {
    diagnostics_
        .Report(Kind::kKoordTypeMismatch, e.span, fmt::format("`{}` is a module, not a value", e.text))
        .Help("name one of its ports");
    return model_.types.error();
  }
  Undeclared(e.text, e.span);
  return model_.types.error();
}

// `kind`: the robot's own value, or a cell or port of another one.
TypeId Checker::ReadVariable(ExprId id, size_t variable, RefKind kind) {
  const Variable& v = model_.variables[variable];
  Set(id, kind, variable);
  const Span span = exprs_[id].span;
  if (v.function >= 0) {
    diagnostics_.Report(Kind::kKoordTypeMismatch, span, fmt::format("`{}` must be called", v.name))
        .At(v.span, "a callable port");
    return model_.types.error();
  }
  if (v.kind == VariableKind::kActuator && place_ != Place::kSpec && !writing_) {
    diagnostics_
        .Report(Kind::kKoordActuatorRead, span, fmt::format("actuator `{}` can only be written", v.name))
        .At(v.span, "declared as an actuator here")
        .Help("keep the value in a local variable as well");
  }
  if (v.kind == VariableKind::kAllread && kind == RefKind::kVariable) {
    return model_.types.Array(v.type, kRobotsLength);
  }
  return v.type;
}

bool Checker::IsModuleName(ExprId id) const {
  const lang::Expr& e = exprs_[id];
  if (e.kind != ExprKind::kName || !IsModule(e.text)) return false;
  return std::none_of(scope_.begin(), scope_.end(),
                      [&](uint32_t b) { return model_.bindings[b].name == e.text; });
}

int Checker::FindPort(const std::string& module, const std::string& port, Span span, bool report) {
  const int found = FindVariable(module + "." + port);
  if (found >= 0 || !report) return found;
  auto& problem = diagnostics_.Report(Kind::kKoordUnknownMember, span,
                                      fmt::format("module `{}` has no port `{}`", module, port));
  std::vector<std::string> ports;
  std::string list;
  for (const Variable& v : model_.variables) {
    if (v.module != module) continue;
    ports.push_back(v.name.substr(module.size() + 1));
    list += (list.empty() ? "`" : ", `") + ports.back() + "`";
  }
  if (const std::string near = lang::Suggest(port, ports); !near.empty()) {
    problem.Help(fmt::format("did you mean `{}`?", near))
        .Fix({span.file, span.end - static_cast<uint32_t>(port.size()), span.end}, near);
  } else if (!list.empty()) {
    problem.Help(fmt::format("its ports are {}", list));
  }
  return -1;
}

TypeId Checker::Field(ExprId id, const lang::Expr& e) {
  const ExprId base = e.args[0];
  if (IsModuleName(base)) {
    const int port = FindPort(exprs_[base].text, e.text, e.span, true);
    return port < 0 ? model_.types.error() : ReadVariable(id, static_cast<size_t>(port), RefKind::kVariable);
  }
  // M[i].port: robot i's port.
  if (exprs_[base].kind == ExprKind::kIndex && IsModuleName(exprs_[base].args[0])) {
    const std::string& module = exprs_[exprs_[base].args[0]].text;
    const int port = FindPort(module, e.text, e.span, true);
    NeedType(exprs_[base].args[1], model_.types.integer(), "the number of a robot");
    if (port < 0) return model_.types.error();
    if (place_ != Place::kSpec) {
      diagnostics_.Report(Kind::kKoordSpecScope, e.span, "a program cannot read another robot's port")
          .Help("share the value in an `allread` variable; `M[i].port` is for specifications");
      return model_.types.error();
    }
    return ReadVariable(id, static_cast<size_t>(port), RefKind::kPortOf);
  }
  return FieldOf(id, e, Expr(base));
}

TypeId Checker::FieldOf(ExprId id, const lang::Expr& e, TypeId base) {
  auto& types = model_.types;
  const lang::Type& type = types[base];
  if (type.kind == TypeKind::kError) return types.error();
  if (type.kind == TypeKind::kRecord || type.kind == TypeKind::kTuple) {
    for (size_t i = 0; i < type.fields.size(); ++i) {
      if (type.fields[i] == e.text) {
        Set(id, RefKind::kNone, i);
        return type.parts[i];
      }
    }
    auto& report = diagnostics_.Report(Kind::kKoordUnknownMember, e.span,
                                       fmt::format("`{}` has no member `{}`", types.Name(base), e.text));
    if (const std::string near = lang::Suggest(e.text, type.fields); !near.empty()) {
      report.Help(fmt::format("did you mean `{}`?", near));
    } else {
      report.Help(fmt::format("its members are {}", fmt::join(type.fields, ", ")));
    }
    return types.error();
  }
  if (type.kind == TypeKind::kOpaque) {
    // The papers' programs read members of types that nobody defines: functions of them.
    const std::string name = fmt::format("{}.{}", type.name, e.text);
    const size_t f = FunctionNamed(name, 1, e.span);
    types.Unify(model_.functions[f].parameters[0], base);
    Set(id, RefKind::kOpaqueField, f);
    return model_.functions[f].result;
  }
  diagnostics_.Report(Kind::kKoordUnknownMember, e.span, fmt::format("`{}` has no members", types.Name(base)))
      .At(exprs_[e.args[0]].span, fmt::format("this is {}", types.WithArticle(base)));
  return types.error();
}

TypeId Checker::Index(ExprId id, const lang::Expr& e) {
  auto& types = model_.types;
  const lang::Expr& base = exprs_[e.args[0]];
  NeedType(e.args[1], types.integer(), "an index");
  if (base.kind == ExprKind::kName) {
    const bool hidden = std::any_of(scope_.begin(), scope_.end(),
                                    [&](uint32_t b) { return model_.bindings[b].name == base.text; });
    const int v = hidden ? -1 : FindVariable(base.text);
    if (v >= 0) {
      const Variable& variable = model_.variables[static_cast<size_t>(v)];
      const bool other = place_ == Place::kSpec && variable.PerRobot() && variable.module.empty();
      if (variable.kind == VariableKind::kAllread || other)
        return ReadVariable(id, static_cast<size_t>(v), RefKind::kCell);
    }
    // Whether a robot has executed `stop`.
    if (!hidden && v < 0 && base.text == "stopped" && place_ == Place::kSpec) {
      Set(id, RefKind::kStopped, 0);
      return types.boolean();
    }
    if (!hidden && IsModule(base.text)) {
      diagnostics_.Report(Kind::kKoordTypeMismatch, e.span, "a module of a robot is not a value")
          .Help("name one of its ports");
      return types.error();
    }
  }
  const TypeId type = Expr(e.args[0]);
  switch (types[type].kind) {
    case TypeKind::kArray:
    case TypeKind::kList:
      return types[type].parts[0];
    case TypeKind::kError:
      return types.error();
    case TypeKind::kVariable: {
      const TypeId element = types.FreshVariable();
      types.Unify(type, types.List(element));
      return element;
    }
    case TypeKind::kBool:
    case TypeKind::kInt:
    case TypeKind::kFloat:
    case TypeKind::kString:
    case TypeKind::kStream:
    case TypeKind::kRecord:
    case TypeKind::kTuple:
    case TypeKind::kEnum:
    case TypeKind::kOpaque:
      break;
  }
  diagnostics_
      .Report(Kind::kKoordNotIndexable, e.span, fmt::format("`{}` cannot be indexed", types.Name(type)))
      .At(base.span, fmt::format("this is {}", types.WithArticle(type)));
  return types.error();
}

}  // namespace rondo::koord
