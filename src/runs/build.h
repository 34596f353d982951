#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codegen/koord/generate.h"
#include "runs/fleet_files.h"
#include "workspace/koord_files.h"

/// Makes projects in C++ of Koord programs.
namespace rondo::runs {

/// Says what `rondo build` is to make.
struct BuildRequest {
  std::string file;                ///< the program, with or without `.koord`
  std::string spec;                ///< empty: beside the program, if there is one
  std::string fleet;               ///< empty: beside the program, if there is one and `robots` is not given
  std::optional<uint64_t> robots;  ///< instead of those of the fleet
  codegen::Capacities capacities;  ///< count more than those of the fleet
};

/// Holds what C++ is made of.
struct BuildSource {
  std::unique_ptr<workspace::LoadedKoord> loaded;
  std::unique_ptr<koord::semantics::Team> team;  ///< points into `loaded`
  codegen::Capacities capacities;
};

/// Loads a program for as many robots as the request or the fleet says, with its parameters. Returns nothing after a report.
std::optional<BuildSource> LoadToBuild(const BuildRequest& request, workspace::Session& session);

/// Is a project: its files, the header and the source of the program first, and which belong to who uses it, and are not made again.
struct BuiltProject {
  std::string name;
  size_t robots = 0;
  struct File {
    std::string name, text;
  };
  std::vector<File>
      files;  ///< in the order in which they are to be written: nothing can be made of some of them
  std::vector<File> to_fill_in;
};

/// Returns the project of a program: the program, a class that answers its questions for the user to fill in, and what CMake needs
/// to make a library of it. Returns nothing after a report.
std::optional<BuiltProject> Build(const BuildRequest& request, workspace::Session& session);

}  // namespace rondo::runs
