#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "choreo/draw/chart.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "lang/expr_printer.h"
#include "lang/suggest.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

using choreo::Graph;
using choreo::Node;
using choreo::NodeKind;

struct Options {
  std::vector<std::string> files;
  std::string choreography;
  std::string svg;
  bool json = false;
};

std::string_view KindName(NodeKind kind) {
  switch (kind) {
    case NodeKind::kMessage:
      return "message";
    case NodeKind::kMotion:
      return "motion";
    case NodeKind::kChoice:
      return "choice";
    case NodeKind::kMerge:
      return "merge";
    case NodeKind::kFork:
      return "fork";
    case NodeKind::kJoin:
      return "join";
    case NodeKind::kEnd:
      return "end";
  }
  return "";
}

std::string Describe(const Graph& graph, const lang::ExprPool& pool, const Node& n) {
  switch (n.kind) {
    case NodeKind::kMessage:
      return fmt::format("{} -> {}: {}", graph.NameOf(n.from), graph.NameOf(n.to), n.label);
    case NodeKind::kMotion: {
      std::string text;
      for (const choreo::Part& p : n.parts) {
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", graph.NameOf(p.robot),
                            graph.instances[p.instance].text);
      }
      return text;
    }
    case NodeKind::kChoice: {
      std::string text = graph.NameOf(n.chooser) + ":";
      for (const choreo::ExprId guard : n.guards)
        text += guard.valid() ? " [" + lang::PrintExpr(pool, guard) + "]" : " [otherwise]";
      return text;
    }
    case NodeKind::kFork: {
      std::string text;
      for (const choreo::Scope& thread : n.threads)
        text += (text.empty() ? "" : " || ") + graph.Names(thread);
      return text;
    }
    case NodeKind::kMerge:
    case NodeKind::kJoin:
    case NodeKind::kEnd:
      break;
  }
  return "";
}

nlohmann::json ToJson(const Graph& graph, const lang::ExprPool& pool) {
  nlohmann::json nodes = nlohmann::json::array();
  for (const Node& n : graph.nodes) {
    nlohmann::json next = nlohmann::json::array();
    for (const choreo::NodeId id : n.next) next.push_back(id.value);
    nlohmann::json robots = nlohmann::json::array();
    for (const choreo::RobotId r : n.scope) robots.push_back(graph.NameOf(r));
    nodes.push_back(
        {{"kind", KindName(n.kind)}, {"text", Describe(graph, pool, n)}, {"robots", robots}, {"next", next}});
  }
  return {{"choreography", graph.source->name.text}, {"start", graph.start.value}, {"nodes", nodes}};
}

std::string ToText(const Graph& graph, const lang::ExprPool& pool) {
  std::string text = fmt::format("{}: begins at {}\n", graph.source->name.text, graph.start.value);
  for (size_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& n = graph.nodes[i];
    std::string next;
    for (const choreo::NodeId id : n.next) next += fmt::format(" {}", id.value);
    text += fmt::format("{:>4}: {:8}{}{}{}\n", i, KindName(n.kind), Describe(graph, pool, n),
                        next.empty() ? "" : " ->", next);
  }
  return text;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const auto module = workspace::LoadModule(options.files, {}, session);
  std::vector<const Graph*> graphs;
  std::vector<std::string> names;
  for (const Graph& graph : module->graphs) {
    names.push_back(graph.source->name.text);
    if (options.choreography.empty() || options.choreography == names.back()) graphs.push_back(&graph);
  }
  const bool good = !session.diagnostics.has_errors();
  if (good && graphs.empty()) {
    const std::string near = lang::Suggest(options.choreography, names);
    PrintFailure(options.choreography.empty()
                     ? std::string("there is no choreography in these files")
                     : fmt::format("there is no choreography `{}`{}", options.choreography,
                                   near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
    return ExitStatus::kRejected;
  }
  if (good && !options.svg.empty()) {
    if (graphs.size() == 1)
      return WritePicture(options.svg, choreo::DrawChart(*graphs[0], module->module.exprs));
    PrintFailure("a picture shows one choreography: choose one by --choreography");
    return ExitStatus::kUsage;
  }
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Graph* graph : graphs) list.push_back(ToJson(*graph, module->module.exprs));
    PrintJson({{"command", "graph"},
               {"status", good ? ExitStatus::kEstablished : ExitStatus::kRejected},
               {"graphs", good ? list : nlohmann::json::array()},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
  } else {
    for (const Graph* graph : graphs) Print(ToText(*graph, module->module.exprs));
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return good ? ExitStatus::kEstablished : ExitStatus::kRejected;
}

}  // namespace

void AddGraphVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "graph", "show a choreography: as a picture, a list or JSON");
  verb.Option("FILE", options->files, "a `.rondo` file, and a `.chor` file about its world if there is one")
      .Required();
  verb.Option("--choreography", options->choreography, "only this one");
  verb.Option("--svg", options->svg, "write a picture to this file: a lane for each robot, time downwards");
  verb.Flag("--json", options->json, "nodes and edges as JSON on standard output");
  verb.Footer("example: rondo graph examples/choreo/handover.rondo --svg handover.svg");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
