#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/new_project.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string folder;
  std::string of = "koord";
  bool json = false;
};

ExitStatus Run(const Options& options) {
  std::filesystem::path folder(options.folder);
  if (!folder.has_filename()) folder = folder.parent_path();  // `fleet/`
  const std::string name = folder.filename().string();
  std::string why = runs::WrongName(name);
  std::vector<std::string> files;
  if (why.empty()) {
    const auto written = runs::WriteProject(folder, name, options.of);
    if (written.ok()) {
      files = written.value();
    } else {
      why = written.error().message;
    }
  }
  if (!why.empty()) return Refuse("new", options.folder, options.json, {}, {}, why);
  if (options.json) {
    PrintJson({{"command", "new"},
               {"folder", folder.string()},
               {"template", options.of},
               {"written", files},
               {"status", ExitStatus::kEstablished},
               {"diagnostics", nlohmann::json::array()}});
    return ExitStatus::kEstablished;
  }
  std::string text = fmt::format("{}: {}\n", folder.string(), fmt::join(files, ", "));
  text += fmt::format("  cd {}\n", folder.string());
  if (options.of == "koord")
    text += fmt::format("  rondo prove {0}.koord\n  rondo simulate {0}.koord\n", name);
  if (options.of == "choreography")
    text += fmt::format("  rondo prove {0}.rondo\n  rondo simulate {0}.rondo\n", name);
  if (options.of == "controller") text += fmt::format("  rondo reach {}.rondo\n", name);
  Print(text);
  return ExitStatus::kEstablished;
}

}  // namespace

void AddNewVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "new", "begin a project: a program with a promise that is proved, and what runs it");
  verb.Option("FOLDER", options->folder, "a new folder; the last part of its name is that of the project")
      .Required();
  verb.Option(
          "--template", options->of,
          "koord: one program for a fleet; choreography: messages and motions of two robots; controller: a robot whose "
          "contracts are proved against its dynamics")
      .OneOf({"koord", "choreography", "controller"});
  verb.Flag("--json", options->json, "what was written as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo new fleet && cd fleet && rondo prove fleet.koord && rondo simulate fleet.koord\n"
      "  rondo new --template choreography visit && cd visit && ./check");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
