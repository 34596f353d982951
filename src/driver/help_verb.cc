#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "driver/command.h"
#include "driver/main.h"
#include "driver/terminal.h"
#include "driver/usage.h"
#include "driver/verbs.h"

namespace rondo::driver {

using verdict::ExitStatus;

void AddHelpVerb(CLI::App& app, ExitStatus& status) {
  auto name = std::make_shared<std::string>();
  Command verb(app, "help", "show the options and an example of a verb");
  verb.Option("VERB", *name, "a verb; without one, all of them are listed");
  verb.Footer("example: rondo help simulate");
  verb.Run([name, &app, &status] {
    const auto verbs = app.get_subcommands([&](const CLI::App* sub) { return sub->get_name() == *name; });
    status = name->empty() || !verbs.empty() ? ExitStatus::kEstablished : ExitStatus::kUsage;
    if (name->empty()) return Print(app.get_formatter()->make_help(&app, "rondo", CLI::AppFormatMode::Normal));
    if (verbs.empty()) return PrintFailure(NoSuchVerb(app, *name));
    Print(verbs.front()->help("rondo"));
  });
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
