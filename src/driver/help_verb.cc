#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "base/file.h"
#include "driver/command.h"
#include "driver/main.h"
#include "driver/man_pages.h"
#include "driver/terminal.h"
#include "driver/usage.h"
#include "driver/verbs.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string verb;
  std::string pages;
};

ExitStatus WritePages(const CLI::App& app, const std::string& folder) {
  if (const std::string why = Folder(folder); !why.empty()) {
    PrintFailure(why);
    return ExitStatus::kRejected;
  }
  for (const auto& [name, text] : ManPages(app)) {
    const auto written = base::WriteFileAtomically(std::filesystem::path(folder) / name, text);
    if (written.ok()) continue;
    PrintFailure(fmt::format("cannot write `{}`: {}", name, written.error().message));
    return ExitStatus::kRejected;
  }
  return ExitStatus::kEstablished;
}

ExitStatus Help(const CLI::App& app, const Options& options) {
  if (!options.pages.empty()) return WritePages(app, options.pages);
  if (options.verb.empty()) {
    Print(app.get_formatter()->make_help(&app, "rondo", CLI::AppFormatMode::Normal));
    return ExitStatus::kEstablished;
  }
  const CLI::App* verb = FindVerb(app, options.verb);
  if (verb == nullptr) {
    PrintFailure(NoSuchVerb(app, options.verb));
    return ExitStatus::kUsage;
  }
  Print(verb->help("rondo"));
  return ExitStatus::kEstablished;
}

}  // namespace

void AddHelpVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "help", "show the options and an example of a verb");
  verb.Option("VERB", options->verb, "a verb; without one, all of them are listed");
  verb.Option("--pages", options->pages, "write everything as manual pages into this folder instead");
  verb.Footer(
      "examples:\n"
      "  rondo help simulate\n"
      "  rondo help --pages ~/.local/share/man/man1 && man rondo-prove");
  verb.Run([options, &app, &status] { status = Help(app, *options); });
}

void AddVersionVerb(CLI::App& app, ExitStatus& status) {
  Command verb(app, "version", "say which version this is");
  verb.Footer("example: rondo version");
  verb.Run([&status] {
    status = ExitStatus::kEstablished;
    Print(VersionText() + "\n");
  });
}

}  // namespace rondo::driver
