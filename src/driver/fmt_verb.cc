#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/check.h"
#include "base/file.h"
#include "choreo/syntax/format.h"
#include "choreo/syntax/parser.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/syntax/format.h"
#include "koord/syntax/parser.h"
#include "workspace/koord_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  bool check = false;
  bool print = false;
};

// The canonical text of a file; nothing if it cannot be read or has errors, which are in the session then.
// Never one that does not mean the same.
std::optional<std::string> FormatKoord(const std::string& file, workspace::Session& session) {
  const auto program = workspace::ReadKoord({file, {}, false}, session);
  if (!program || session.diagnostics.has_errors()) return std::nullopt;
  const std::string text = koord::Format(session.sources, *program);
  workspace::Session again;
  koord::Program reread;
  koord::Parse(again.sources, again.sources.Add(file, text), reread, again.diagnostics);
  CHECK(!again.diagnostics.has_errors() && koord::Skeleton(reread) == koord::Skeleton(*program))
      << "formatting would change " << file;
  CHECK(reread.comments.size() == program->comments.size()) << "formatting would lose a comment of " << file;
  return text;
}

std::optional<std::string> FormatMotion(const std::string& file, workspace::Session& session) {
  const auto source = workspace::ReadSource(file, workspace::Wanted::kMotion, session);
  if (!source) return std::nullopt;
  choreo::Module module;
  choreo::Parse(session.sources, *source, module, session.diagnostics);
  if (session.diagnostics.has_errors()) return std::nullopt;
  const lang::TokenStream tokens = choreo::Tokens(session.sources, *source, session.diagnostics);
  const std::string text = choreo::Format(session.sources, *source, tokens);
  workspace::Session again;
  const diag::FileId other = again.sources.Add(file, text);
  const lang::TokenStream reread = choreo::Tokens(again.sources, other, again.diagnostics);
  const auto same = [](const auto& a, const auto& b) { return a.text == b.text; };
  CHECK(std::ranges::equal(tokens.tokens, reread.tokens, same) &&
        std::ranges::equal(tokens.comments, reread.comments, same))
      << "formatting would change " << file;
  return text;
}

ExitStatus FormatFile(const std::string& file, const Options& options) {
  workspace::Session session;
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".chor" || extension == ".rosl") {
    PrintFailure(fmt::format("`{}`: files of the original tool are not formatted", file));
    return ExitStatus::kRejected;
  }
  const auto formatted = extension == ".rondo" ? FormatMotion(file, session) : FormatKoord(file, session);
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
