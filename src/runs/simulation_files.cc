#include "runs/simulation_files.h"

#include <filesystem>

namespace rondo::runs {

SimulationFiles FindSimulationFiles(const std::string& file, const std::string& spec,
                                    const std::string& fleet) {
  std::filesystem::path stem(file);
  if (stem.extension() == ".koord" || stem.extension() == ".toml") stem.replace_extension();
  SimulationFiles files{file, spec, fleet};
  std::error_code ignored;
  const std::filesystem::path program(stem.string() + ".koord");
  // A program may have any name; one without an extension is looked for beside the others.
  if (std::filesystem::path(file).extension() != ".koord" &&
      (std::filesystem::path(file).extension() == ".toml" ||
       !std::filesystem::is_regular_file(file, ignored)))
    files.program = program.string();
  if (files.fleet.empty()) files.fleet = stem.string() + ".toml";
  return files;
}

void KeepTexts(const SimulationFiles& files, const workspace::Session& session, const FileContents& of_fleet,
               sim::SimulationOptions& options) {
  if (!of_fleet.empty()) options.files = ToJson(of_fleet);
  options.program_name = std::filesystem::path(files.program).filename().string();
  for (size_t f = 0; f < session.sources.size(); ++f) {
    const diag::FileId id(f);
    const std::string path(session.sources.path(id));
    if (workspace::IsModuleFile(path)) continue;  // of the fleet
    std::string& text = path == files.program   ? options.program
                        : path == files.fleet   ? options.fleet
                        : path == files.network ? options.network_text
                                                : options.spec;
    text = session.sources.text(id);
  }
}

}  // namespace rondo::runs
