#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "deploy/keystore.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/robot_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string file;
  std::string fleet;
  std::string spec;
  std::string folder;
  bool json = false;
};

ExitStatus Fail(const Options& options, const workspace::Session& session, const std::string& why) {
  return Refuse("keys", options.file, options.json, session.sources, session.diagnostics, why);
}

ExitStatus Run(Options options) {
  workspace::Session session;
  // A fleet stands for the program beside it.
  const std::filesystem::path file(options.file);
  if (file.extension() == ".toml" && options.fleet.empty()) {
    options.fleet = options.file;
    options.file = std::filesystem::path(file).replace_extension(".koord").string();
  }
  const auto program = runs::LoadRobotProgram(
      runs::FindSimulationFiles(options.file, options.spec, options.fleet), {}, session);
  if (!program) return Fail(options, session, {});
  const std::string folder = options.folder.empty() ? program->keys : options.folder;
  if (folder.empty())
    return Fail(
        options, session,
        fmt::format("`{}` does not say where its keys are: `keys = \"keys\"` in its `[ros]`, or `-o FOLDER`",
                    program->files.fleet));
  const auto enclaves = deploy::EnclavesOf(program->loaded->model, program->fleet,
                                           program->texts.program_name, session.diagnostics);
  if (session.diagnostics.has_errors()) return Fail(options, session, {});
  const auto made = deploy::MakeKeystore(folder, enclaves, program->texts);
  if (!made.ok()) return Fail(options, session, made.error().message);
  if (options.json) {
    nlohmann::json names = nlohmann::json::array();
    for (const auto& enclave : enclaves) names.push_back(enclave.name);
    PrintJson({{"command", "keys"},
               {"file", program->files.program},
               {"folder", folder},
               {"owner", made.value().fresh ? "made" : "kept"},
               {"enclaves", names},
               {"made", made.value().named},
               {"status", ExitStatus::kEstablished},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    return ExitStatus::kEstablished;
  }
  std::string text =
      fmt::format("{}: {}\n", folder, made.value().fresh ? "a new owner" : "the owner is known");
  text += fmt::format("  {} made, {} signed\n", base::Counted(made.value().named.size(), "key"),
                      base::Counted(enclaves.size(), "enclave"));
  text += fmt::format("copy to each robot its folder alone, such as {}/enclaves{}; {}/private stays here\n",
                      folder, deploy::EnclaveOf(program->fleet.robots.front()), folder);
  Print(text);
  PrintDiagnostics(session.sources, session.diagnostics);
  return ExitStatus::kEstablished;
}

}  // namespace

void AddKeysVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "keys",
               "make keys for the robots of a fleet, and sign what each may do and what they run");
  verb.Option(
          "FILE", options->file,
          "the Koord program that the fleet runs, with or without `.koord`; `NAME.toml` beside it is the fleet")
      .Required();
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("-o,--output", options->folder,
              "the folder of the keys; default: `keys` in `[ros]` of the fleet");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo keys fleet.koord\n"
      "  rondo keys fleet.koord -o keys\n"
      "\n"
      "The folder is one that `ros2 security` makes and knows (sros2). Who has no key of its owner is neither heard nor hears;\n"
      "robots say and hear what the program needs, and nothing else. To be called again when one of the files has changed:\n"
      "keys stay, and what was signed is signed again. docs/robots.md says more.\n"
      "exit status: 0 made, 1 something is wrong");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
