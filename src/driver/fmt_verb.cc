#include <fmt/format.h>

#include <filesystem>

#include "base/file.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "workspace/checks.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  bool check = false;
  bool print = false;
};

ExitStatus FormatFile(const std::string& file, const Options& options) {
  workspace::Session session;
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".chor" || extension == ".rosl") {
    PrintFailure(fmt::format("`{}`: files of the original tool are not formatted", file));
    return ExitStatus::kRejected;
  }
  const auto formatted = workspace::FormattedFile(file, session);
  if (!formatted) {
    PrintDiagnostics(session.sources, session.diagnostics);
    return ExitStatus::kRejected;
  }
  const std::string& text = *formatted;
  if (options.print) {
    Print(text);
    return ExitStatus::kEstablished;
  }
  if (session.sources.text(diag::FileId(0)) == text) return ExitStatus::kEstablished;
  if (options.check) {
    Print(fmt::format("{} is not formatted\n", file));
    return ExitStatus::kRejected;
  }
  const auto written = base::WriteFileAtomically(file, text);
  if (!written.ok()) {
    PrintFailure(fmt::format("cannot write `{}`: {}", file, written.error().message));
    return ExitStatus::kRejected;
  }
  Print(fmt::format("formatted {}\n", file));
  return ExitStatus::kEstablished;
}

}  // namespace

void AddFormatVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "fmt", "write programs and choreographies in their canonical form");
  verb.Option("FILE", options->files,
              "Koord programs, specifications, robots and choreographies, rewritten in place")
      .Required();
  verb.Flag("--check", options->check, "change nothing; fail if a file is not formatted");
  verb.Flag("--stdout", options->print, "print the result instead of writing it");
  verb.Footer("example: rondo fmt --check examples/koord/*.koord");
  verb.Run([options, &status] {
    for (const std::string& file : options->files)
      status = verdict::Worse(status, FormatFile(file, *options));
  });
}

}  // namespace rondo::driver
