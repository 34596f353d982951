#include "choreo/node/cast.h"

#include "choreo/node/process_script.h"
#include "choreo/node/projection_script.h"

namespace rondo::choreo {

Cast MakeCast(const Module& module, Graph& graph, Declarations& declarations, bool projections) {
  Cast cast{&graph, &declarations, {}, {}};
  cast.processes.resize(graph.robots.size());
  for (size_t r = 0; r < graph.robots.size(); ++r)
    cast.types.push_back(
        Project(graph, declarations.evaluator().pool(), RobotId(r), declarations.evaluator().diagnostics()));
  for (const Item& item : module.items) {
    const auto* process = std::get_if<ProcessDef>(&item);
    if (process == nullptr || projections) continue;
    const std::string& of = process->choreography.text;
    const auto robot = graph.Find(process->robot.text);
    if (!robot || (!of.empty() && of != graph.source->name.text)) continue;
    cast.processes[robot->index()] = BuildFlow(*process, graph, declarations);
  }
  return cast;
}

std::unique_ptr<runtime::sessions::Program> ScriptOf(const Cast& cast, RobotId robot, Senses& senses) {
  const auto& process = cast.processes[robot.index()];
  if (process) return std::make_unique<ProcessScript>(*cast.graph, *process, *cast.declarations, senses);
  return std::make_unique<ProjectionScript>(*cast.graph, cast.declarations->evaluator().arena(),
                                            cast.types[robot.index()], senses);
}

}  // namespace rondo::choreo
