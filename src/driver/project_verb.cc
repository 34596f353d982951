#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "choreo/draw/automaton.h"
#include "choreo/project/project.h"
#include "choreo/wellformed/wellformed.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "lang/expr_printer.h"
#include "lang/suggest.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

using choreo::Action;

struct Options {
  std::string file;
  std::string robot;
  std::string svg;
  bool json = false;
};

nlohmann::json ToJson(const choreo::Graph& graph, const lang::ExprPool& pool, const choreo::LocalType& type) {
  nlohmann::json states = nlohmann::json::array();
  for (const choreo::LocalState& s : type.states) {
    nlohmann::json actions = nlohmann::json::array();
    for (const auto& [action, to] : s.next) {
      nlohmann::json j{{"action", action.kind == Action::Kind::kSend      ? "send"
                                  : action.kind == Action::Kind::kReceive ? "receive"
                                                                          : "move"},
                       {"label", action.label},
                       {"to", to.value}};
      if (action.peer.valid()) j["peer"] = graph.NameOf(action.peer);
      actions.push_back(std::move(j));
    }
    nlohmann::json choice = nlohmann::json::array();
    for (const auto& [guard, to] : s.choice)
      choice.push_back(
          {{"guard", guard.valid() ? lang::PrintExpr(pool, guard) : "otherwise"}, {"to", to.value}});
    states.push_back({{"actions", actions}, {"choice", choice}, {"ends", s.ends}});
  }
  return {{"choreography", graph.source->name.text}, {"robot", graph.NameOf(type.robot)}, {"states", states}};
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const auto module = workspace::LoadModule({options.file}, {}, session);
  nlohmann::json list = nlohmann::json::array();
  std::string text, picture;
  std::vector<std::string> robots;
  for (const choreo::Graph& graph : module->graphs) {
    choreo::CheckWellFormed(graph, session.diagnostics);
    for (size_t r = 0; r < graph.robots.size(); ++r) {
      robots.push_back(graph.robots[r].text);
      if (!options.robot.empty() && options.robot != robots.back()) continue;
      const size_t errors = session.diagnostics.errors();
      const auto type = choreo::Project(graph, module->module.exprs, choreo::RobotId(r), session.diagnostics);
      if (session.diagnostics.errors() > errors) continue;
      list.push_back(ToJson(graph, module->module.exprs, type));
      picture = choreo::DrawAutomaton(graph, module->module.exprs, type);
      text += fmt::format("{} in {}\n{}", robots.back(), graph.source->name.text,
                          choreo::ToText(graph, module->module.exprs, type));
    }
  }
  const bool good = !session.diagnostics.has_errors();
  if (good && list.empty() && !options.robot.empty()) {
    const std::string near = lang::Suggest(options.robot, robots);
    PrintFailure(fmt::format("there is no robot `{}`{}", options.robot,
                             near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
    return ExitStatus::kRejected;
  }
  if (good && !options.svg.empty()) {
    if (list.size() != 1) {
      PrintFailure("a picture shows one robot: name it behind the file");
      return ExitStatus::kUsage;
    }
    return WritePicture(options.svg, picture);
  }
  if (options.json) {
    const nlohmann::json diagnostics = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson({{"command", "project"},
               {"status", good ? ExitStatus::kEstablished : ExitStatus::kRejected},
               {"types", good ? list : nlohmann::json::array()},
               {"diagnostics", diagnostics}});
  } else {
    if (good) Print(text);
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return good ? ExitStatus::kEstablished : ExitStatus::kRejected;
}

}  // namespace

void AddProjectVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "project", "show what each robot of a choreography does: its local type");
  verb.Option("FILE", options->file, "robots, a world and choreographies (`.rondo`)").Required();
  verb.Option("ROBOT", options->robot, "only this robot");
  verb.Option("--svg", options->svg, "write the automaton of one robot as a picture to this file");
  verb.Flag("--json", options->json, "the automata as JSON on standard output");
  verb.Footer(
      "example: rondo project examples/choreo/handover.rondo arm\n"
      "         rondo project examples/choreo/handover.rondo arm --svg arm.svg\n"
      "\n"
      "Each line is a step: the state, what the robot does or what happens to it, and the state behind it.");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
