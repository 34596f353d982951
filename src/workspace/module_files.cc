#include "workspace/module_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "choreo/graph/lower.h"
#include "choreo/process/typing.h"
#include "choreo/project/project.h"
#include "choreo/syntax/chor_parser.h"
#include "choreo/syntax/parser.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::workspace {
namespace {

namespace fs = std::filesystem;

class Reader {
 public:
  Reader(Session& session, choreo::Module& module) : session_(session), module_(module) {}

  bool Read(const std::string& file) {
    if (!IsNew(file)) return true;
    const auto source = ReadSource(file, Wanted::kMotion, session_);
    if (source) Parse(file, *source);
    return source.has_value();
  }

 private:
  bool IsNew(const std::string& file) {
    std::error_code ignored;
    const fs::path path = fs::weakly_canonical(file, ignored);
    return seen_.insert(ignored ? file : path.string()).second;
  }

  // What a file imports is read behind it: a `.chor` file is about the world of the file that imports it.
  void Parse(const std::string& file, diag::FileId source) {
    const fs::path path(file);
    diag::Diagnostics& diagnostics = session_.diagnostics;
    if (path.extension() == ".chor")
      return choreo::ParseEquations(session_.sources, source, module_, diagnostics);
    if (path.extension() == ".rosl")
      return choreo::ParseProgram(session_.sources, source, path.stem().string(), module_, diagnostics);
    const size_t before = module_.items.size();
    choreo::Parse(session_.sources, source, module_, diagnostics);
    for (size_t i = before, end = module_.items.size(); i < end; ++i) {
      const auto* import = std::get_if<choreo::ImportDef>(&module_.items[i]);
      if (import != nullptr) Import(choreo::ImportDef(*import), path.parent_path());
    }
  }

  void Import(const choreo::ImportDef& import, const fs::path& folder) {
    const std::string file = (folder / import.path).lexically_normal().string();
    if (!IsNew(file)) return;
    auto text = session_.read(file);
    if (!text.ok()) {
      session_.diagnostics
          .Report(diag::Kind::kChoreoImport, import.span, fmt::format("cannot read `{}`", file))
          .Note(text.error().message)
          .Help("paths are relative to the file that imports");
      return;
    }
    Parse(file, session_.sources.Add(file, std::move(text).value()));
  }

  Session& session_;
  choreo::Module& module_;
  std::set<std::string> seen_;
};

}  // namespace

bool IsModuleFile(const std::string& file) {
  const std::string extension = fs::path(file).extension().string();
  return extension == ".rondo" || extension == ".chor" || extension == ".rosl";
}

std::unique_ptr<LoadedModule> LoadModule(const std::vector<std::string>& files,
                                         const std::vector<std::string>& options, Session& session,
                                         const robot::Loose* loose) {
  auto module = std::make_unique<LoadedModule>();
  const size_t errors = session.diagnostics.errors();
  Reader reader(session, module->module);
  for (const std::string& file : files) {
    if (!reader.Read(file)) return module;
  }
  if (session.diagnostics.errors() > errors) return module;
  for (choreo::Item& item : module->module.items) {
    auto* choreography = std::get_if<choreo::ChoreographyDef>(&item);
    if (choreography == nullptr) continue;
    for (const std::string& option : options)
      choreography->options.push_back({option, choreography->name.span});
  }
  module->declarations =
      std::make_unique<choreo::Declarations>(module->module, module->arena, session.diagnostics, loose);
  module->graphs = choreo::Lower(module->module, *module->declarations);
  return module;
}

std::optional<std::vector<choreo::SideCondition>> CheckStructure(LoadedModule& module, Session& session) {
  if (module.declarations == nullptr) return std::nullopt;  // nothing beyond syntax errors
  const size_t before = session.diagnostics.errors();
  std::vector<choreo::Typed> typed;
  for (choreo::Graph& graph : module.graphs) {
    const size_t errors = session.diagnostics.errors();
    choreo::CheckWellFormed(graph, session.diagnostics);
    // What is not well-formed has projections that only repeat why.
    if (session.diagnostics.errors() > errors) continue;
    std::vector<choreo::LocalType> types;
    for (size_t r = 0; r < graph.robots.size(); ++r)
      types.push_back(choreo::Project(graph, module.module.exprs, choreo::RobotId(r), session.diagnostics));
    if (session.diagnostics.errors() == errors) typed.push_back({&graph, std::move(types)});
  }
  if (session.diagnostics.errors() > before) return std::nullopt;
  return choreo::CheckProcesses(module.module, typed, *module.declarations);
}

void CheckModule(const std::vector<std::string>& files, const std::vector<std::string>& options,
                 Session& session) {
  const auto module = LoadModule(files, options, session);
  const auto conditions = CheckStructure(*module, session);
  if (!conditions) return;
  for (const choreo::SideCondition& c : *conditions)
    session.diagnostics.Report(diag::Kind::kProcessOpen, c.span, fmt::format("it is left open {}", c.what));
}

}  // namespace rondo::workspace
