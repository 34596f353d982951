#include "codegen/koord/generate.h"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/koord/emitter.h"
#include "codegen/koord/names.h"
#include "codegen/koord/templates.h"

namespace rondo::codegen {

using koord::Variable;
using koord::VariableKind;
using koord::semantics::EventCode;
using koord::semantics::FormulaCode;
using koord::semantics::Layout;
using lang::TypeKind;

namespace {

/// Puts the parts of a program together.
class Assembly {
 public:
  Assembly(const koord::semantics::Team& team, const diag::SourceSet& sources, const GenerateOptions& options,
           diag::Diagnostics& diagnostics)
      : team_(team),
        model_(team.model()),
        name_(CppStem(options.name)),
        digest_(options.digest),
        types_(team, options.capacities, diagnostics),
        emitter_(team, sources, types_, diagnostics),
        diagnostics_(diagnostics) {}

  GeneratedProgram Make() {
    Variables();
    const std::string events = Bodies();
    const std::string formulas = Formulas();
    for (const std::string& type : types_.Unused())
      diagnostics_
          .Report(diag::Kind::kKoordNotBuildable, {}, fmt::format("the program has no type `{}`", type))
          .Help(fmt::format("types with a capacity: {}", fmt::join(types_.capable(), ", ")));
    std::vector<std::string> methods;
    for (const Emitter::External& external : emitter_.external_functions()) {
      std::string parameters;
      for (size_t i = 0; i < external.parameters.size(); ++i)
        parameters += ParameterText(external.parameters[i], external.parameter_names[i]) + ", ";
      methods.push_back(fmt::format("Answer {}(int64_t robot, {}{}& result) noexcept", external.name,
                                    parameters, external.result));
      calls_ += fmt::format("  virtual {} = 0;\n", methods.back());
    }
    return {name_, Header(), Source(events, formulas), Core(), methods};
  }

 private:
  struct Member {
    std::string type, name;
  };

  // The structures that hold the state, and its cells.
  void Variables();
  std::string Struct(const std::string& name, VariableKind kind, const std::string& more = {});
  std::string Cells();
  std::string Cell(size_t variable, const std::string& now, size_t depth);
  std::string Visit(const std::string& now, size_t depth);

  std::string Bodies();
  void Table(const std::string& name, const std::string& type, const std::vector<std::string>& rows);
  std::string Formulas();
  std::string Formula(const std::string& prefix, size_t number, const std::string& name, koord::ExprId e);
  std::string Header();
  std::string Source(const std::string& events, const std::string& formulas);
  std::string Core() const;
  static std::string Signature(std::string text, const std::string& body, bool to);

  const koord::semantics::Team& team_;
  const koord::Model& model_;
  std::string name_;
  uint64_t digest_;
  Types types_;
  Emitter emitter_;
  diag::Diagnostics& diagnostics_;
  std::string params_, shared_, local_, in_, out_, changes_, cells_, each_cell_, each_shared_, each_own_;
  std::string events_, tables_, declared_, calls_;
};

std::string Assembly::Struct(const std::string& name, VariableKind kind, const std::string& more) {
  std::string members, module;
  for (size_t i = 0; i < model_.variables.size(); ++i) {
    const Variable& v = model_.variables[i];
    if (!team_.layout()[i].exists) continue;
    const bool shared = kind == VariableKind::kAllwrite && v.Shared();
    if (!shared && v.kind != kind) continue;
    std::string type = types_.Of(v.type, v.span);
    if (v.kind == VariableKind::kAllread) type = fmt::format("std::array<{}, kRobots>", type);
    if (v.module.empty()) {
      members += fmt::format("  {} {}{{}};\n", type, CppName(v.name));
      continue;
    }
    if (module != v.module) {
      if (!module.empty()) members += fmt::format("  }} {};\n", CppName(module));
      members += fmt::format("  struct {}Ports {{\n", v.module);
      module = v.module;
    }
    members += fmt::format("    {} {}{{}};\n", type, CppName(v.name.substr(v.module.size() + 1)));
  }
  if (!module.empty()) members += fmt::format("  }} {};\n", CppName(module));
  return fmt::format("struct {} {{\n{}{}}};\n\n", name, members, more);
}

std::string Assembly::Cell(size_t variable, const std::string& now, size_t depth) {
  const std::string name = emitter_.NameOf(variable);
  if (depth == 0) return fmt::format("    cell(cell::{0}, changes.{0}, {1});\n", name, now);
  return fmt::format(
      "    for (size_t k = 0; k < Step::Count<{2}>({1}); ++k)\n"
      "      cell(cell::{0} + k, Step::Nested<{2}>(changes.{0}, k), Step::Nested<{2}>({1}, k));\n",
      name, now, depth);
}

std::string Assembly::Visit(const std::string& now, size_t depth) {
  if (depth == 0) return fmt::format("    visit({});\n", now);
  return fmt::format(
      "    for (size_t k = 0; k < Step::Count<{1}>({0}); ++k) visit(Step::Nested<{1}>({0}, k));\n", now,
      depth);
}

void Assembly::Variables() {
  size_t cells = 0;
  for (size_t i = 0; i < model_.variables.size(); ++i) {
    const Variable& v = model_.variables[i];
    const Layout::Place& place = team_.layout()[i];
    if (!place.exists) continue;
    const std::string type = types_.Of(v.type, v.span);
    if (v.kind == VariableKind::kParam) {
      const auto words = team_.params().subspan(place.at, place.width);
      const bool constant = types_.Is(v.type, TypeKind::kInt) || types_.Is(v.type, TypeKind::kFloat) ||
                            types_.Is(v.type, TypeKind::kBool) || types_.Is(v.type, TypeKind::kEnum);
      params_ += fmt::format("inline {} {} {} = {};\n", constant ? "constexpr" : "const", type,
                             CppName(v.name), types_.Literal(v.type, words, v.span));
      continue;
    }
    const std::string part = v.kind == VariableKind::kLocal      ? "local."
                             : v.kind == VariableKind::kActuator ? "out."
                             : v.kind == VariableKind::kSensor   ? "in."
                                                                 : "shared.";
    const std::string now = part + emitter_.PathOf(i) + (v.kind == VariableKind::kAllread ? "[robot]" : "");
    (v.PerRobot() ? each_own_ : each_shared_) += Visit(now, place.dimensions.size());
    if (v.kind == VariableKind::kSensor) continue;
    const std::string name = emitter_.NameOf(i);
    const size_t depth = place.dimensions.size();
    changes_ += fmt::format("  {} {}{{}};\n", type, name);
    cells_ += fmt::format("  {} = {},\n", name, cells);
    cells += std::max<uint32_t>(1, place.length);
    each_cell_ += Cell(i, now, depth);
  }
  changes_ += "  bool stopped = false;\n";
  cells_ += fmt::format("  stopped = {},\n  kCount = {},\n", cells, cells + 1);
  each_cell_ += "    cell(cell::stopped, changes.stopped, local.stopped);\n";
  shared_ = Struct("Shared", VariableKind::kAllwrite);
  local_ = Struct("Local", VariableKind::kLocal, "  bool stopped = false;\n");
  in_ = Struct("In", VariableKind::kSensor);
  out_ = Struct("Out", VariableKind::kActuator);
}

// A parameter that is not used has no name.
std::string Assembly::Signature(std::string text, const std::string& body, bool to) {
  const auto used = [&](const std::string& what) { return body.find(what) != std::string::npos; };
  if (!used("r.") && !used("(r,"))
    text += "Step&";
  else
    text += "Step& r";
  const bool view = used("v.") || used(" v,") || used(", v)");
  text += view ? ", const View<Program>& v" : ", const View<Program>&";
  if (to) text += used("to.") ? ", To& to" : ", To&";
  return text + ")";
}

std::string Assembly::Bodies() {
  std::string text, names;
  std::vector<std::string> rows, begins;
  const auto body = [&](const std::string& function, const std::vector<koord::Stmt>& statements, bool apart) {
    const std::string lines = emitter_.Body(statements, apart);
    text += fmt::format("{} {{\n{}}}\n\n", Signature(fmt::format("void {}(", function), lines, true), lines);
  };
  for (const EventCode& event : team_.events()) {
    const std::string name = CppName(event.def->name);
    names += (names.empty() ? "" : ", ") + name;
    if (event.def->pre.valid()) {
      const std::string guard = emitter_.Formula(event.def->pre);
      text +=
          fmt::format("{} {{\n{}}}\n\n", Signature(fmt::format("bool guard_{}(", name), guard, false), guard);
    }
    body("event_" + name, event.def->body, true);
    rows.push_back(fmt::format("{{{}, {}, {}, events::event_{}}}", CppString(event.def->name), event.urgent,
                               event.def->pre.valid() ? fmt::format("events::guard_{}", name) : "nullptr",
                               name));
  }
  events_ = names;
  Table("kEvents", "EventCode<Program>", rows);
  rows.clear();
  for (size_t i = 0; i < model_.inits.size(); ++i) {
    body(fmt::format("init_{}", i), model_.inits[i]->body, false);
    rows.push_back(fmt::format("events::init_{}", i));
  }
  const auto initial = [&](const std::vector<koord::semantics::InitialCode>& codes) {
    for (const koord::semantics::InitialCode& code : codes) {
      const std::string name = "begin_" + emitter_.NameOf(code.variable);
      const std::string line = emitter_.Initial(code.variable, code.value);
      text += fmt::format("{} {{\n{}}}\n\n", Signature(fmt::format("void {}(", name), line, true), line);
      begins.push_back(fmt::format("{{events::{}, {}}}", name, model_.variables[code.variable].PerRobot()));
    }
  };
  initial(team_.declared());
  initial(team_.derived());
  Table("kBegins", "BeginBody", begins);
  Table("kInits", "InitBody", rows);
  rows.clear();
  for (const koord::FallbackDef* def : model_.fallbacks) {
    const std::string name = fmt::format("fallback_{}", CppName(def->module));
    body(name, def->code.body, false);
    rows.push_back(fmt::format("{{{}, false, nullptr, events::{}}}", CppString(def->module), name));
  }
  Table("kFallbacks", "EventCode<Program>", rows);
  return text;
}

// A table of the program. `type`: of its items, as the class `Program` calls it.
void Assembly::Table(const std::string& name, const std::string& type, const std::vector<std::string>& rows) {
  declared_ += fmt::format("  static const std::array<{}, {}> {};\n", type, rows.size(), name);
  const bool own = type.find('<') == std::string::npos;
  tables_ += fmt::format("const std::array<{}{}, {}> Program::{}{{", own ? "Program::" : "", type,
                         rows.size(), name);
  if (!rows.empty()) tables_ += "{\n";
  for (const std::string& row : rows) tables_ += fmt::format("    {},\n", row);
  tables_ += rows.empty() ? "};\n" : "}};\n";
}

std::string Assembly::Formula(const std::string& prefix, size_t number, const std::string& name,
                              koord::ExprId e) {
  const std::string body = emitter_.Formula(e);
  const auto used = [&](const std::string& what) { return body.find(what) != std::string::npos; };
  const bool step = body.find("r.") != std::string::npos || body.find("(r,") != std::string::npos;
  return fmt::format(
      "// {}\nbool {}_{}(Step&{}, const View<Program>&{}, const View<Program>&{}) {{\n{}}}\n\n",
      diag::Escaped(name), prefix, number, step ? " r" : "", used("v.") || used(" v,") ? " v" : "",
      used("old.") || used(" old,") ? " old" : "", body);
}

std::string Assembly::Formulas() {
  std::string text;
  const auto list = [&](const std::string& table, const std::string& prefix,
                        const std::vector<FormulaCode>& formulas) {
    std::vector<std::string> rows;
    for (size_t i = 0; i < formulas.size(); ++i) {
      text += Formula(prefix, i, formulas[i].name, formulas[i].body);
      rows.push_back(fmt::format("{{{}, {}, formulas::{}_{}}}", CppString(formulas[i].name),
                                 formulas[i].per_robot, prefix, i));
    }
    Table(table, "FormulaCode<Program>", rows);
  };
  list("kInvariants", "invariant", team_.invariants());
  list("kInitially", "initially", team_.initially());
  list("kFacts", "fact", team_.facts());
  list("kPortFacts", "port_fact", team_.port_facts());
  std::vector<std::string> rows;
  const auto& promises = team_.promises();
  for (size_t i = 0; i < promises.size(); ++i) {
    if (promises[i].p.valid()) text += Formula("when", i, promises[i].name, promises[i].p);
    text += Formula("always", i, promises[i].name, promises[i].q);
    const auto row = [&](const std::string& formula) {
      return fmt::format("{{{}, true, formulas::{}_{}}}", CppString(promises[i].name), formula, i);
    };
    rows.push_back(fmt::format("{{{}, {}, {}}}",
                               promises[i].p.valid() ? row("when") : "{\"\", true, nullptr}", row("always"),
                               promises[i].at_end));
  }
  Table("kPromises", "Promise", rows);
  return text;
}

std::string Assembly::Header() {
  return fmt::format(fmt::runtime(kHeader), fmt::arg("name", name_), fmt::arg("digest", digest_),
                     fmt::arg("robots", team_.robots()), fmt::arg("text", types_.TextCapacity()),
                     fmt::arg("said", types_.SaidCapacity()),
                     fmt::arg("lines", std::max<uint32_t>(32, types_.SaidCapacity() / 32)),
                     fmt::arg("types", types_.definitions()), fmt::arg("params", params_),
                     fmt::arg("shared", shared_), fmt::arg("local", local_), fmt::arg("in", in_),
                     fmt::arg("out", out_), fmt::arg("events", events_), fmt::arg("changes", changes_),
                     fmt::arg("cells", cells_), fmt::arg("calls", calls_), fmt::arg("tables", declared_),
                     fmt::arg("each", each_cell_), fmt::arg("each_shared", each_shared_),
                     fmt::arg("each_own", each_own_));
}

std::string Assembly::Source(const std::string& events, const std::string& formulas) {
  std::string functions, accessors;
  for (const FunctionText& f : emitter_.functions())
    functions += fmt::format("[[maybe_unused]] {} {}\n\n", f.signature, f.body);
  const auto section = [](const std::string& comment, const std::string& name, const std::string& text) {
    return text.empty()
               ? ""
               : fmt::format(
                     "{0}namespace {1} {{\nnamespace {{\n\n{2}}}  // namespace\n}}  // namespace {1}\n\n",
                     comment, name, text);
  };
  for (const auto& [_, text] : emitter_.accessors()) accessors += "  " + text + "\n";
  return fmt::format(
      fmt::runtime(kSource), fmt::arg("name", name_), fmt::arg("include", "#include"),
      fmt::arg("accessors", accessors),
      fmt::arg(
          "functions",
          section(
              "// The functions of the program, which have no value where `r` has a fault. `at`: where they are called.\n",
              "functions", functions)),
      fmt::arg("events", events),
      fmt::arg(
          "formulas",
          section(
              "// What the specification says of the state `v`; `old`: the one at the end of the program transition.\n",
              "formulas", formulas)),
      fmt::arg("tables", tables_));
}

// What loads the program without knowing its types (rondo/program/core.h).
std::string Assembly::Core() const {
  std::string asking, names;
  size_t number = 0;
  for (const auto& external : emitter_.external_functions()) {
    std::string parameters, arguments;
    for (size_t i = 0; i < external.parameters.size(); ++i) {
      parameters += ParameterText(external.parameters[i], fmt::format("a{}", i)) + ", ";
      arguments += fmt::format(", a{}", i);
    }
    asking += fmt::format(
        "  Answer {}(int64_t robot, {}{}& result) noexcept override {{ return AskCore(host, {}, robot, result{}); }}\n",
        external.name, parameters, external.result, number++, arguments);
    names += fmt::format("{}{}", names.empty() ? "" : ", ", CppString(external.of));
  }
  return fmt::format(fmt::runtime(kCore), fmt::arg("name", name_), fmt::arg("include", "#include"),
                     fmt::arg("methods", asking), fmt::arg("questions", names));
}

}  // namespace

GeneratedProgram Generate(const koord::semantics::Team& team, const diag::SourceSet& sources,
                          const GenerateOptions& options, diag::Diagnostics& diagnostics) {
  Assembly assembly(team, sources, options, diagnostics);
  return assembly.Make();
}

}  // namespace rondo::codegen
