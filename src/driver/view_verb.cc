#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/page.h"
#include "driver/terminal.h"
#include "driver/verbs.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string trace;
  std::string page;
  bool open = false;
  bool json = false;
};

ExitStatus Run(const Options& options) {
  const auto page = WritePage(options.trace, options.page);
  const ExitStatus status = page.ok() ? ExitStatus::kEstablished : ExitStatus::kRejected;
  const bool opened = page.ok() && options.open && OpenInBrowser(page.value());
  if (options.json) {
    nlohmann::json out{{"command", "view"}, {"file", options.trace}, {"opened", opened}, {"status", status}};
    if (page.ok())
      out["page"] = page.value();
    else
      out["error"] = page.error().message;
    PrintJson(out);
  } else if (!page.ok()) {
    PrintFailure(page.error().message);
  } else {
    Print(fmt::format("page: {}\n", page.value()));
    if (options.open && !opened) Print("no browser was found: open it by hand\n");
  }
  return status;
}

}  // namespace

void AddViewVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "view", "make a page on which a run can be looked at, in a browser");
  verb.Option("TRACE", options->trace, "a trace, the log of a robot, or a run that `rondo explore` saved")
      .Required();
  verb.Option("-o,--output", options->page, "where to write the page (HTML); default: beside the trace");
  verb.Flag("--open", options->open, "show it at once");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo simulate examples/koord/lineform --trace line.mcap\n"
      "  rondo view line.mcap --open\n"
      "  rondo view line.mcap -o line.html\n"
      "  rondo explore examples/koord/mutex_naive.koord --save bad.json\n"
      "  rondo view bad.json\n"
      "\n"
      "The page is one file with everything in it: it can be sent to others, and loads nothing from anywhere. Key `?` in it\n"
      "says which keys there are (docs/viewer.md).\n"
      "exit status: 0 the page is there, 1 it is not");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
