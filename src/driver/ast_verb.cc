#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/load.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/syntax/format.h"
#include "koord/syntax/json.h"

namespace rondo::driver {

void AddAstVerb(CLI::App& app, int& status) {
  struct Options {
    std::string file;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("ast", "show how a Koord program is read");
  verb->add_option("FILE", options->file, "a program or specification")->required();
  verb->add_flag("--json", options->json,
                 "the syntax tree as JSON; otherwise the canonical text without comments");
  verb->footer("example: rondo ast --json examples/koord/lineform.koord");
  verb->callback([options, &status] {
    Session session;
    const auto program = Load({options->file, {}, false}, session);
    if (!program || session.diagnostics.has_errors()) {
      PrintDiagnostics(session.sources, session.diagnostics);
      status = kRejected;
      return;
    }
    if (options->json) {
      PrintJson(koord::ToJson(session.sources, *program));
    } else {
      Print(koord::Skeleton(*program));
    }
  });
}

}  // namespace rondo::driver
