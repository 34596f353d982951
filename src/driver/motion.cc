#include "driver/motion.h"

#include "choreo/graph/lower.h"
#include "choreo/project/project.h"
#include "choreo/syntax/parser.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::driver {

std::unique_ptr<Motion> LoadMotion(const std::string& file, Session& session) {
  const auto source = ReadSource(file, session);
  if (!source) return nullptr;
  auto motion = std::make_unique<Motion>();
  const size_t errors = session.diagnostics.errors();
  choreo::Parse(session.sources, *source, motion->module, session.diagnostics);
  if (session.diagnostics.errors() == errors)
    motion->graphs = choreo::Lower(motion->module, session.diagnostics);
  return motion;
}

bool CheckMotion(const std::string& file, Session& session) {
  const auto motion = LoadMotion(file, session);
  if (motion == nullptr) return false;
  for (const choreo::Graph& graph : motion->graphs) {
    const size_t errors = session.diagnostics.errors();
    choreo::CheckWellFormed(graph, session.diagnostics);
    // What is not well-formed has projections that only repeat why.
    if (session.diagnostics.errors() > errors) continue;
    for (size_t r = 0; r < graph.robots.size(); ++r)
      choreo::Project(graph, motion->module.exprs, choreo::RobotId(r), session.diagnostics);
  }
  return true;
}

}  // namespace rondo::driver
