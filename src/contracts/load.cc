#include "contracts/load.h"

#include <fmt/format.h>

#include <filesystem>

#include "koord/ports/port_problem.h"
#include "lang/suggest.h"
#include "robot/dynamics/symmetry.h"

namespace rondo::contracts {

using diag::Kind;

std::vector<ContractResult> ContractsOf(workspace::LoadedModule& module, bool reduce, std::string_view keep,
                                        std::vector<std::string>* left_out) {
  std::vector<ContractResult> all;
  const choreo::Graph* of = nullptr;
  const auto add = [&](const robot::World& world, const robot::Body& body,
                       const robot::MotionInstance& instance) {
    ContractResult result;
    result.span = instance.motion->name.span;
    result.graph = of;
    result.motion = fmt::format("{}.{}", body.type->name.text, instance.motion->name.text);
    auto problem = robot::ProblemOf(world, body, instance, module.arena);
    result.made.problem.name = fmt::format("{}: {}", body.name.text, instance.text);
    if (problem.ok()) {
      result.made = std::move(problem).value();
    } else {
      result.impossible = problem.error().message;
    }
    if (reduce && result.impossible.empty()) {
      if (auto reduced = robot::WithoutPlace(world, body, instance, module.declarations->evaluator(), keep)) {
        result.anywhere = std::move(reduced->parameters);
        result.at_zero = std::move(reduced->anywhere);
        if (reduced->made) result.made = std::move(*reduced->made);
      }
    }
    all.push_back(std::move(result));
  };
  for (const choreo::Graph& graph : module.graphs) {
    of = &graph;
    for (const choreo::Instance& i : graph.instances) {
      robot::MotionInstance instance;
      instance.text = i.text;
      instance.motion = i.motion;
      instance.arguments = i.args;
      instance.contract = i.contract;
      instance.control = i.control;
      instance.duration = i.duration.most;
      instance.least = i.duration.least;
      instance.interruptible = i.duration.interruptible;
      add(*graph.world, graph.BodyOf(i.robot), instance);
    }
  }
  if (!module.graphs.empty()) return all;
  for (const choreo::Item& item : module.module.items) {
    const auto* type = std::get_if<robot::RobotDef>(&item);
    if (type == nullptr) continue;
    auto world = std::make_shared<robot::World>();
    for (const robot::MotionInstance& i :
         robot::MotionsOf(*type, module.declarations->evaluator(), *world, left_out))
      add(*world, world->bodies[0], i);
  }
  return all;
}

std::vector<ContractResult> PortContractsOf(const workspace::LoadedKoord& koord, Platforms& platforms,
                                            workspace::Session& session, const robot::Loose* loose) {
  std::vector<ContractResult> all;
  for (const koord::PlatformDef* platform : koord.model.platforms) {
    const std::filesystem::path beside = session.sources.path(platform->span.file);
    const std::string file = (beside.parent_path() / platform->file).lexically_normal().string();
    if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
      session.diagnostics
          .Report(Kind::kChoreoImport, platform->file_span, fmt::format("there is no file `{}`", file))
          .Help("paths are relative to the specification");
      continue;
    }
    auto module = workspace::LoadModule({file}, {}, session, loose);
    if (module->declarations == nullptr) continue;
    const robot::RobotDef* type = nullptr;
    std::vector<std::string> names;
    for (const choreo::Item& item : module->module.items) {
      const auto* def = std::get_if<robot::RobotDef>(&item);
      if (def == nullptr) continue;
      names.push_back(def->name.text);
      if (def->name.text == platform->type) type = def;
    }
    auto world = std::make_unique<robot::World>();
    if (type == nullptr || !robot::StandAlone(*type, module->declarations->evaluator(), *world)) {
      auto& report = session.diagnostics.Report(
          Kind::kChoreoUndeclared, platform->file_span,
          type == nullptr ? fmt::format("there is no robot type `{}` in `{}`", platform->type, file)
                          : fmt::format("`{}` has parameters without a value", platform->type));
      if (const std::string near = lang::Suggest(platform->type, names); type == nullptr && !near.empty())
        report.Help(fmt::format("did you mean `{}`?", near));
      continue;
    }
    for (koord::PortProblem& p : koord::PortProblems(koord.model, *platform, *world, world->bodies[0],
                                                     module->arena, session.diagnostics, loose)) {
      ContractResult result;
      result.span = p.assumption->span;
      result.made = std::move(p.made);
      result.made.problem.name = p.name;
      result.impossible = std::move(p.impossible);
      result.domain = std::move(p.domain);
      result.model = platform->type;
      all.push_back(std::move(result));
    }
    platforms.files.push_back(std::move(module));
    platforms.worlds.push_back(std::move(world));
  }
  return all;
}

bool LoadContracts(const std::vector<std::string>& files, const std::string& spec, const robot::Loose* loose,
                   bool reduce, workspace::Session& session, LoadedContracts& loaded) {
  if (files.size() == 1 && !workspace::IsModuleFile(files[0])) {
    loaded.koord = workspace::LoadKoord({files[0], spec}, session);
    if (loaded.koord == nullptr) return false;
    loaded.results = PortContractsOf(*loaded.koord, loaded.platforms, session, loose);
  } else {
    loaded.module = workspace::LoadModule(files, {}, session, loose);
    if (loaded.module->declarations == nullptr || session.diagnostics.has_errors()) return false;
    loaded.results =
        ContractsOf(*loaded.module, reduce, loose == nullptr ? "" : loose->name, &loaded.left_out);
  }
  return !session.diagnostics.has_errors();
}

}  // namespace rondo::contracts
