#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/view_page.h"
#include "trace/reader.h"

namespace rondo::driver {

namespace fs = std::filesystem;
using verdict::ExitStatus;

namespace {

struct Options {
  std::string trace;
  std::string page;
  bool open = false;
  bool json = false;
};

// Shows a file with whatever the desktop has for it. False if there is nothing.
bool Open(const std::string& path) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(STDOUT_FILENO);
    ::close(STDERR_FILENO);
    ::execlp("xdg-open", "xdg-open", path.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  return pid > 0 && ::waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

ExitStatus Fail(const Options& options, const std::string& why) {
  if (options.json)
    PrintJson(
        {{"command", "view"}, {"file", options.trace}, {"problem", why}, {"status", ExitStatus::kRejected}});
  else
    PrintFailure(why);
  return ExitStatus::kRejected;
}

ExitStatus Run(const Options& options) {
  const auto bytes = trace::ReadTrace(options.trace);
  if (!bytes.ok())
    return Fail(options, fmt::format("cannot read `{}`: {}", options.trace, bytes.error().message));
  const auto whole = trace::ForEachMessage(bytes.value(), [](const trace::Message&) { return false; });
  if (!whole.ok())
    return Fail(options, fmt::format("`{}` is no trace: {}", options.trace, whole.error().message));
  const auto page = runs::PageOf(fs::path(options.trace).filename().string(), bytes.value());
  if (!page.ok()) return Fail(options, page.error().message);
  const std::string path =
      options.page.empty() ? fs::path(options.trace).replace_extension(".html").string() : options.page;
  std::error_code ignored;
  if (fs::equivalent(path, options.trace, ignored))
    return Fail(options, fmt::format("`{}` is the trace: the page would take its place", path));
  const auto written = base::WriteFileAtomically(path, page.value());
  if (!written.ok())
    return Fail(options, fmt::format("cannot write `{}`: {}", path, written.error().message));
  const bool opened = options.open && Open(path);
  if (options.json) {
    PrintJson({{"command", "view"},
               {"file", options.trace},
               {"page", path},
               {"bytes", page.value().size()},
               {"opened", opened},
               {"status", ExitStatus::kEstablished}});
    return ExitStatus::kEstablished;
  }
  Print(fmt::format("page: {}\n", path));
  if (options.open && !opened) Print("no browser was found: open it by hand\n");
  return ExitStatus::kEstablished;
}

}  // namespace

void AddViewVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "view", "make a page on which a run can be looked at, in a browser");
  verb.Option("TRACE", options->trace, "what `rondo simulate --trace` or `rondo launch --trace` wrote")
      .Required();
  verb.Option("-o,--output", options->page, "where to write the page (HTML); default: beside the trace");
  verb.Flag("--open", options->open, "show it at once");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo simulate examples/koord/lineform --trace line.mcap\n"
      "  rondo view line.mcap --open\n"
      "  rondo view line.mcap -o line.html\n"
      "\n"
      "The page is one file with everything in it: it can be sent to others, and loads nothing from anywhere. Key `?` in it\n"
      "says which keys there are.\n"
      "exit status: 0 the page is there, 1 it is not");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
