#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/syntax/format.h"
#include "koord/syntax/json.h"
#include "workspace/koord_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

void AddAstVerb(CLI::App& app, ExitStatus& status) {
  struct Options {
    std::string file;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  Command verb(app, "ast", "show how a Koord program is read");
  verb.Option("FILE", options->file, "a program or specification").Required();
  verb.Flag("--json", options->json,
            "the syntax tree as JSON; otherwise the canonical text without comments");
  verb.Footer("example: rondo ast --json examples/koord/lineform.koord");
  verb.Run([options, &status] {
    workspace::Session session;
    const auto program = workspace::ReadKoord({options->file, {}, false}, session);
    if (!program || session.diagnostics.has_errors()) {
      status = Refuse("ast", options->file, options->json, session.sources, session.diagnostics, "");
      return;
    }
    if (options->json) {
      PrintJson({{"command", "ast"},
                 {"file", options->file},
                 {"status", ExitStatus::kEstablished},
                 {"program", koord::ToJson(session.sources, *program)},
                 {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    } else {
      Print(koord::Skeleton(*program));
    }
  });
}

}  // namespace rondo::driver
