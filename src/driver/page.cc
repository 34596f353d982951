#include "driver/page.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/file.h"
#include "driver/terminal.h"
#include "runs/run_file.h"
#include "runs/run_trace.h"
#include "runs/trace_copy.h"
#include "runs/view_page.h"
#include "trace/reader.h"
#include "workspace/koord_files.h"

namespace rondo::driver {

namespace fs = std::filesystem;

namespace {

// The trace, or a trace of the run that was saved.
base::Result<std::string> Trace(const std::string& path) {
  auto bytes = trace::ReadTrace(path);
  if (!bytes.ok()) return base::Error{fmt::format("cannot read `{}`: {}", path, bytes.error().message)};
  if (!bytes.value().starts_with('{')) return bytes;
  const auto run = runs::ReadRun(bytes.value());
  if (!run.ok()) return base::Error{fmt::format("`{}`: {}", path, run.error().message)};
  workspace::Session session;
  const auto loaded = workspace::LoadKoord({run.value().program, run.value().spec, true}, session);
  if (!loaded)
    return base::Error{
        fmt::format("`{}`: the program of the run, `{}`, cannot be used", path, run.value().program)};
  return runs::CopyOf(
      [&](const std::string& copy) { return runs::WriteRunTrace(copy, run.value(), session); });
}

}  // namespace

base::Result<std::string> WritePage(const std::string& trace, const std::string& page) {
  const auto bytes = Trace(trace);
  if (!bytes.ok()) return bytes.error();
  // A log of a robot that was killed has no end, and is shown as far as it goes.
  const auto nothing = [](const trace::Message&) { return false; };
  const auto whole = trace::ForEachMessage(bytes.value(), nothing);
  if (!whole.ok() && !trace::ForEachMessageLeft(bytes.value(), nothing).ok())
    return base::Error{fmt::format("`{}` is no trace: {}", trace, whole.error().message)};
  const auto made = runs::PageOf(fs::path(trace).filename().string(), bytes.value());
  if (!made.ok()) return made.error();
  const std::string path = page.empty() ? fs::path(trace).replace_extension(".html").string() : page;
  std::error_code ignored;
  if (fs::equivalent(path, trace, ignored))
    return base::Error{fmt::format("`{}` is the trace: the page would take its place", path)};
  const auto written = base::WriteFileAtomically(path, made.value());
  if (!written.ok()) return base::Error{fmt::format("cannot write `{}`: {}", path, written.error().message)};
  return path;
}

bool OpenInBrowser(const std::string& path) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    // Only what is allowed between fork and exec.
    ::close(STDOUT_FILENO);
    ::close(STDERR_FILENO);
    ::execlp("xdg-open", "xdg-open", path.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  return pid > 0 && ::waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string PlaceForTrace() {
  const auto folder = base::MakeTemporaryFolder();
  if (folder.ok()) return (fs::path(folder.value()) / "run.mcap").string();
  PrintFailure(fmt::format("cannot make a folder for the trace: {}", folder.error().message));
  return "";
}

void ShowTrace(const std::string& trace, bool json) {
  std::error_code ignored;
  if (!fs::is_regular_file(trace, ignored)) return;
  const auto page = WritePage(trace, "");
  if (!page.ok()) {
    PrintFailure(page.error().message);
    return;
  }
  const bool opened = OpenInBrowser(page.value());
  if (!json)
    Print(
        fmt::format("page: {}{}\n", page.value(), opened ? "" : " (no browser was found: open it by hand)"));
}

}  // namespace rondo::driver
