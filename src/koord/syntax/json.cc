#include "koord/syntax/json.h"

#include <nlohmann/json.hpp>

#include "lang/expr_json.h"
#include "lang/expr_printer.h"

namespace rondo::koord {
namespace {

using nlohmann::json;

class Writer {
 public:
  Writer(const diag::SourceSet& sources, const Program& program) : sources_(sources), program_(program) {}

  json operator()(const AgentHeader& i) const { return Named("agent", i.name, i.span); }
  json operator()(const FunctionDef& i) const {
    json j = Named("function", i.name, i.span);
    j["parameters"] = Decls(i.parameters);
    if (!i.result.name.empty()) j["result"] = Type(i.result);
    if (i.has_body) j["body"] = Body(i.body);
    return j;
  }
  json operator()(const AdtDef& i) const {
    json j = Named("adt", i.name, i.span);
    j["fields"] = Decls(i.fields);
    return j;
  }
  json operator()(const EnumDef& i) const {
    json j = Named("enum", i.name, i.span);
    j["members"] = i.members;
    return j;
  }
  json operator()(const ModuleDef& i) const {
    json j = Named("module", i.name, i.span);
    j["sensors"] = json::array();
    j["actuators"] = json::array();
    for (const PortGroup& group : i.groups) {
      for (const Decl& d : group.ports) j[group.sensors ? "sensors" : "actuators"].push_back(One(d));
    }
    return j;
  }
  json operator()(const Section& i) const {
    constexpr const char* kNames[] = {"allread", "allwrite", "local"};
    json j = At(i.span);
    j["item"] = kNames[static_cast<size_t>(i.kind)];
    j["variables"] = Decls(i.decls);
    return j;
  }
  json operator()(const InitDef& i) const {
    json j = At(i.span);
    j["item"] = "init";
    j["body"] = Body(i.body);
    return j;
  }
  json operator()(const EventDef& i) const {
    json j = Named("event", i.name, i.span);
    if (i.pre.valid()) j["pre"] = Ex(i.pre);
    j["urgent"] = i.urgent;
    j["body"] = Body(i.body);
    return j;
  }
  json operator()(const FallbackDef& i) const {
    json j = Named("fallback", i.module, i.span);
    j["body"] = Body(i.code.body);
    return j;
  }
  json operator()(const ParamDef& i) const {
    json j = One(i.decl);
    j["item"] = "param";
    return j;
  }
  json operator()(const AssumeDef& i) const {
    constexpr const char* kNames[] = {"fact", "initially", "port"};
    json j = Named("assume", i.name, i.span);
    j["assume"] = kNames[static_cast<size_t>(i.kind)];
    if (!i.module.empty()) j["module"] = i.module;
    if (i.when.valid()) j["when"] = Ex(i.when);
    if (i.at_end) j["at_end"] = true;
    j["body"] = Ex(i.body);
    return j;
  }
  json operator()(const SummaryDef& i) const {
    json j = Named("summary", i.function, i.span);
    j["parameters"] = i.parameters;
    j["result"] = i.result;
    j["body"] = Ex(i.body);
    return j;
  }
  json operator()(const InvariantDef& i) const {
    json j = Named("invariant", i.name, i.span);
    if (i.at_rounds) j["at_rounds"] = true;
    j["body"] = Ex(i.body);
    return j;
  }
  json operator()(const ResponseDef& i) const {
    json j = Named("response", i.name, i.span);
    j["when"] = Ex(i.when);
    j["rounds"] = i.rounds;
    j["then"] = Ex(i.then);
    return j;
  }
  json operator()(const PlatformDef& i) const {
    json j = Named("platform", i.module, i.span);
    j["type"] = i.type;
    j["file"] = i.file;
    j["every"] = Ex(i.period);
    return j;
  }
  json operator()(const ExploreDef& i) const {
    constexpr const char* kNames[] = {"value", "choice", "function"};
    json j = At(i.span);
    j["item"] = "explore";
    j["entries"] = json::array();
    for (const ExploreEntry& e : i.entries) {
      json one = At(e.span);
      one["entry"] = kNames[static_cast<size_t>(e.kind)];
      one["name"] = e.name;
      if (e.kind == ExploreKind::kFunction) one["parameters"] = e.parameters;
      one["body"] = Ex(e.body);
      j["entries"].push_back(std::move(one));
    }
    return j;
  }

 private:
  json At(diag::Span span) const {
    const diag::Position p = sources_.Locate(span.file, span.begin);
    return {{"line", p.line}, {"column", p.column}};
  }
  json Named(const char* item, const std::string& name, diag::Span span) const {
    json j = At(span);
    j["item"] = item;
    j["name"] = name;
    return j;
  }
  json Ex(ExprId e) const { return lang::ExprToJson(sources_, program_.exprs, e); }
  std::string Type(const lang::TypeSyntax& t) const { return lang::PrintType(program_.exprs, t); }
  json One(const Decl& d) const {
    json j = At(d.span);
    j["name"] = d.name;
    std::string type = d.members.empty() ? Type(d.type) : "enum";
    for (const ExprId dim : d.dimensions)
      type += "[" + (dim.valid() ? lang::PrintExpr(program_.exprs, dim) : "") + "]";
    j["type"] = type;
    if (!d.members.empty()) j["members"] = d.members;
    if (d.initial.valid()) j["initial"] = Ex(d.initial);
    return j;
  }
  json Decls(const std::vector<Decl>& decls) const {
    json j = json::array();
    for (const Decl& d : decls) j.push_back(One(d));
    return j;
  }
  json Body(const std::vector<Stmt>& body) const {
    json j = json::array();
    for (const Stmt& s : body) j.push_back(Statement(s));
    return j;
  }
  json Statement(const Stmt& s) const {
    json j = At(s.span);
    j["statement"] = WordsOf(s.kind).name;
    if (s.target.valid()) j["target"] = Ex(s.target);
    if (s.value.valid())
      j[s.kind == StmtKind::kIf || s.kind == StmtKind::kWhile ? "condition"
        : s.kind == StmtKind::kForRange                       ? "first"
                                                              : "value"] = Ex(s.value);
    if (s.kind == StmtKind::kWhile) j["within"] = Ex(s.operands[0]);
    if (s.kind == StmtKind::kForRange) j["end"] = Ex(s.operands[0]);
    if (s.kind == StmtKind::kStream) {
      j["operands"] = json::array();
      for (const ExprId e : s.operands) j["operands"].push_back(Ex(e));
    }
    if (!s.update.empty()) j["update"] = s.update;
    if (s.kind == StmtKind::kLocal) j["type"] = Type(s.type);
    if (!s.names.empty()) j["variables"] = s.names;
    if (!s.body.empty()) j["body"] = Body(s.body);
    if (s.has_else) j["else"] = Body(s.orelse);
    return j;
  }

  const diag::SourceSet& sources_;
  const Program& program_;
};

}  // namespace

json ToJson(const diag::SourceSet& sources, const Program& program) {
  json items = json::array();
  const Writer writer(sources, program);
  for (const Item& item : program.items) items.push_back(std::visit(writer, item));
  return {{"items", std::move(items)}};
}

}  // namespace rondo::koord
