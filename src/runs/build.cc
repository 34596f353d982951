#include "runs/build.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/version.h"
#include "koord/native/native_program.h"
#include "koord/semantics/team.h"
#include "runs/simulation_files.h"
#include "sim/parameters.h"

namespace rondo::runs {

namespace {

using koord::semantics::Team;
using koord::semantics::TeamOptions;

constexpr const char* kCMake =
    R"(# Made by `rondo build`. What you add belongs into a CMakeLists.txt of yours, which adds this folder.
cmake_minimum_required(VERSION 3.25)
project(koord_{0} LANGUAGES CXX)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_package(rondo {1} REQUIRED)
add_library(koord_{0} koord/{0}.cc)
target_include_directories(koord_{0} PUBLIC ${{CMAKE_CURRENT_SOURCE_DIR}})
target_link_libraries(koord_{0} PUBLIC rondo::program)
set_target_properties(koord_{0} PROPERTIES POSITION_INDEPENDENT_CODE ON)
# For `rondo run --core`, `launch --core` and `campaign --core`.
add_library(koord_{0}_core MODULE koord/{0}_core.cc)
target_link_libraries(koord_{0}_core PRIVATE koord_{0})
)";

// What `rondo run --core` looks for.
constexpr const char* kExports = R"(
extern "C" int rondo_core_version() {{ return rondo::program::kCoreVersion; }}
extern "C" rondo::program::Core* rondo_make_core() {{ return koord::{0}::MakeCore().release(); }}
)";

std::string Answers(const codegen::GeneratedProgram& program) {
  std::string methods;
  for (const std::string& call : program.calls)
    methods += fmt::format(
        "  {} override {{\n    return Answer::kNone;  // to be filled in: set `result`, return Answer::kValue\n  }}\n",
        call);
  return fmt::format(
      "// What the program asks. This file is yours: `rondo build` makes it once, and leaves it as it is then.\n"
      "#pragma once\n\n#include \"koord/{0}.h\"\n\nnamespace koord::{0} {{\n\nclass Answers : public Calls {{\n public:\n{1}}};\n\n}}  // namespace "
      "{0}\n",
      program.name, methods);
}

}  // namespace

std::optional<BuildSource> LoadToBuild(const BuildRequest& request, workspace::Session& session) {
  const SimulationFiles files = FindSimulationFiles(request.file, request.spec, request.fleet);
  BuildSource source;
  source.capacities = request.capacities;
  source.loaded = workspace::LoadKoord({files.program, files.spec, true}, session);
  if (source.loaded == nullptr) return std::nullopt;
  const koord::Model& model = source.loaded->model;
  TeamOptions options;
  options.hosted = [](size_t) { return true; };  // whoever uses the program answers its questions
  koord::semantics::Heap heap;
  std::error_code none;
  if (!request.fleet.empty() || (!request.robots && std::filesystem::exists(files.fleet, none))) {
    FleetFiles surroundings(files.fleet, session);
    const auto file = workspace::ReadSource(files.fleet, workspace::Wanted::kToml, session);
    if (!file) return std::nullopt;
    const sim::Fleet fleet = surroundings.Read(*file);
    if (session.diagnostics.has_errors()) return std::nullopt;
    options.robots = fleet.robots.size();
    sim::ReadParameters(model, fleet, options, heap, session.diagnostics);
    for (const auto& [type, most] : fleet.capacities) {
      const auto items = static_cast<uint32_t>(most);
      if (type != "others") {
        source.capacities.by_type.try_emplace(type, items);
      } else if (!source.capacities.others) {
        source.capacities.others = items;
      }
    }
  } else if (!request.robots) {
    session.diagnostics
        .Report(diag::Kind::kKoordNotBuildable, {},
                "nothing says for how many robots the program is to be made")
        .Help(fmt::format("`--robots 4`, or a fleet: `{}` is not there", files.fleet));
    return std::nullopt;
  }
  if (request.robots) options.robots = *request.robots;
  source.team = Team::Make(model, options, session.diagnostics, std::move(heap));
  if (source.team == nullptr || session.diagnostics.has_errors()) return std::nullopt;
  return source;
}

std::optional<BuiltProject> Build(const BuildRequest& request, workspace::Session& session) {
  const auto source = LoadToBuild(request, session);
  if (!source) return std::nullopt;
  const std::string stem = std::filesystem::path(request.file).stem().string();
  const codegen::GeneratedProgram program =
      codegen::Generate(*source->team, session.sources,
                        {stem, source->capacities, koord::native::DigestOf(*source->team, session.sources)},
                        session.diagnostics);
  if (session.diagnostics.has_errors()) return std::nullopt;
  BuiltProject project;
  project.name = program.name;
  project.robots = source->team->robots();
  const std::string stem_of_files = "koord/" + program.name;
  project.files = {{stem_of_files + ".h", program.header},
                   {stem_of_files + ".cc", program.source},
                   {stem_of_files + "_core.cc", program.core + fmt::format(kExports, program.name)},
                   {"CMakeLists.txt", fmt::format(kCMake, program.name, base::Version())}};
  if (!program.calls.empty()) project.to_fill_in = {{"answers.h", Answers(program)}};
  return project;
}

}  // namespace rondo::runs
