#include <unistd.h>

#include <filesystem>

#include "driver/command.h"
#include "driver/verbs.h"
#include "lsp/server.h"

namespace rondo::driver {

using verdict::ExitStatus;

void AddLspVerb(CLI::App& app, ExitStatus& status) {
  struct Options {
    bool no_proofs = false;
  };
  auto options = std::make_shared<Options>();
  Command verb(app, "lsp", "serve an editor: errors as you type, proofs when a file is saved");
  verb.Flag("--no-proofs", options->no_proofs, "prove nothing when a file is saved");
  verb.Footer(
      "example: rondo lsp\n"
      "\n"
      "Speaks the Language Server Protocol on standard input and output: editors start it (docs/editors.md).\n"
      "exit status: 0 the editor said goodbye, 1 it went away");
  verb.Run([options, &status] {
    const std::string self =
        options->no_proofs ? "" : std::filesystem::read_symlink("/proc/self/exe").string();
    status =
        lsp::Serve(STDIN_FILENO, STDOUT_FILENO, self) == 0 ? ExitStatus::kEstablished : ExitStatus::kRejected;
  });
}

}  // namespace rondo::driver
