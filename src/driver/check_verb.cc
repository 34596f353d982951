#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/load.h"
#include "driver/motion.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/check/check.h"

namespace rondo::driver {
namespace {

struct Options {
  std::vector<std::string> files;
  std::string spec;
  bool json = false;
};

int Run(const Options& options) {
  Session session;
  bool readable = true;
  for (const std::string& file : options.files) {
    const size_t before = session.diagnostics.errors();
    if (std::filesystem::path(file).extension() == ".rondo") {
      readable = CheckMotion(file, session) && readable;
      continue;
    }
    const auto program = Load({file, options.spec, true}, session);
    if (!program) {
      readable = false;
      continue;
    }
    if (session.diagnostics.errors() == before) koord::Check(*program, session.diagnostics);
  }
  const bool good = readable && !session.diagnostics.has_errors();
  if (options.json) {
    const nlohmann::json list = DiagnosticsToJson(session.sources, session.diagnostics);
    PrintJson({{"command", "check"}, {"ok", good}, {"diagnostics", list}});
  } else {
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return good ? kEstablished : kRejected;
}

}  // namespace

void AddCheckVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("check", "report every error and warning of programs and choreographies");
  verb->add_option(
          "FILE", options->files,
          "Koord programs (`NAME.spec` beside one belongs to it), and robots and choreographies (`.rondo`)")
      ->required();
  verb->add_option("--spec", options->spec, "the specification, if it is not beside the program");
  verb->add_flag("--json", options->json, "the diagnostics as JSON on standard output");
  verb->footer("example: rondo check examples/koord/delivery.koord");
  verb->callback([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
