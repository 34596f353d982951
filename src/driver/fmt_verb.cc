#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "base/check.h"
#include "base/file.h"
#include "driver/exit_status.h"
#include "driver/load.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/syntax/format.h"
#include "koord/syntax/parser.h"

namespace rondo::driver {
namespace {

struct Options {
  std::vector<std::string> files;
  bool check = false;
  bool print = false;
};

int FormatFile(const std::string& file, const Options& options) {
  if (std::filesystem::path(file).extension() == ".rondo") {
    PrintFailure(fmt::format("`{}`: only Koord programs and specifications are formatted so far", file));
    return kRejected;
  }
  Session session;
  const auto program = Load({file, {}, false}, session);
  if (!program) return kRejected;
  if (session.diagnostics.has_errors()) {
    PrintDiagnostics(session.sources, session.diagnostics);
    return kRejected;
  }
  const std::string text = koord::Format(session.sources, *program);
  // Never write what does not mean the same.
  Session again;
  koord::Program reread;
  koord::Parse(again.sources, again.sources.Add(file, text), reread, again.diagnostics);
  CHECK(!again.diagnostics.has_errors() && koord::Skeleton(reread) == koord::Skeleton(*program))
      << "formatting would change " << file;
  CHECK(reread.comments.size() == program->comments.size()) << "formatting would lose a comment of " << file;
  if (options.print) {
    Print(text);
    return kEstablished;
  }
  if (session.sources.text(diag::FileId(0)) == text) return kEstablished;
  if (options.check) {
    Print(fmt::format("{} is not formatted\n", file));
    return kRejected;
  }
  const auto written = base::WriteFileAtomically(file, text);
  if (!written.ok()) {
    PrintFailure(fmt::format("cannot write `{}`: {}", file, written.error().message));
    return kRejected;
  }
  Print(fmt::format("formatted {}\n", file));
  return kEstablished;
}

}  // namespace

void AddFormatVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("fmt", "write Koord programs in their canonical form");
  verb->add_option("FILE", options->files, "programs and specifications, rewritten in place")->required();
  verb->add_flag("--check", options->check, "change nothing; fail if a file is not formatted");
  verb->add_flag("--stdout", options->print, "print the result instead of writing it");
  verb->footer("example: rondo fmt --check examples/koord/*.koord");
  verb->callback([options, &status] {
    for (const std::string& file : options->files) status = std::max(status, FormatFile(file, *options));
  });
}

}  // namespace rondo::driver
