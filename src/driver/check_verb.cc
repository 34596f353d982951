#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/check/check.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string spec;
  std::vector<std::string> admitted;
  bool json = false;
};

ExitStatus Run(const Options& options) {
  workspace::Session session;
  std::vector<std::vector<std::string>>
      motion;  // by `.rondo` file: what is not one belongs to the one before it
  for (const std::string& file : options.files) {
    const size_t before = session.diagnostics.errors();
    if (workspace::IsModuleFile(file)) {
      if (motion.empty() || std::filesystem::path(file).extension() == ".rondo") motion.emplace_back();
      motion.back().push_back(file);
      continue;
    }
    const auto program = workspace::ReadKoord({file, options.spec, true}, session);
    if (program && session.diagnostics.errors() == before) koord::Check(*program, session.diagnostics);
  }
  for (const auto& files : motion) workspace::CheckModule(files, options.admitted, session);
  const ExitStatus status =
      session.diagnostics.has_errors() ? ExitStatus::kRejected : ExitStatus::kEstablished;
  if (options.json) {
    const nlohmann::json list = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson({{"command", "check"}, {"status", status}, {"diagnostics", list}});
  } else {
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return status;
}

}  // namespace

void AddCheckVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "check", "report every error and warning of programs and choreographies");
  verb.Option(
          "FILE", options->files,
          "Koord programs (`NAME.spec` beside one belongs to it); robots and choreographies (`.rondo`), and the original "
          "choreographies (`.chor`) and programs (`ROBOT.rosl`) about the world of a `.rondo` file before them")
      .Required();
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--option", options->admitted,
              "an option for every choreography, as if it were written there: `equal_durations`")
      .OneEach();
  verb.Flag("--json", options->json, "the diagnostics as JSON on standard output");
  verb.Footer(
      "example: rondo check examples/koord/delivery.koord\n"
      "         rondo check examples/choreo/handover.rondo\n"
      "         rondo check world.rondo fetch.chor arm.rosl cart.rosl --option equal_durations");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
