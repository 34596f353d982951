#include "driver/terminal.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"

namespace rondo::driver {

namespace {

// A signal handler can reach nothing but globals.
std::atomic<const base::StopToken*> current{nullptr};

// A second Ctrl-C ends the process at once; who sends SIGTERM may send it more than once.
extern "C" void OnInterrupt(int number) {
  const base::StopToken* stop = current.load();
  if (stop == nullptr || (stop->cancelled() && number == SIGINT)) ::_exit(130);
  stop->RequestStop();
}

}  // namespace

void Print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void PrintJson(nlohmann::json json) {
  json["rondo"] = 1;
  Print(json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void PrintError(const std::string& text) {
  std::fflush(stdout);
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

diag::Colour ErrorColour() {
  const char* no_colour = std::getenv("NO_COLOR");
  const bool wanted = no_colour == nullptr || *no_colour == '\0';
  return wanted && ::isatty(STDERR_FILENO) != 0 ? diag::Colour::kOn : diag::Colour::kOff;
}

void PrintDiagnostics(const diag::SourceSet& sources, const diag::Diagnostics& diagnostics) {
  // Nobody reads many pages: the first ones as a whole, then each in a line, then how many there are.
  constexpr ptrdiff_t kWhole = 76, kMost = 96;  // lines
  std::string text;
  const size_t errors = diagnostics.errors();  // also those that were not kept
  size_t warnings = 0, left = 0;
  ptrdiff_t lines = 0;
  bool whole = true;
  for (const diag::Diagnostic& d : diagnostics.Sorted()) {
    if (d.severity == diag::Severity::kWarning) ++warnings;
    std::string one = diag::RenderText(sources, d, ErrorColour()) + "\n";
    whole = whole && (text.empty() || lines + std::ranges::count(one, '\n') <= kWhole);
    if (!whole) one = diag::RenderLine(sources, d);
    const ptrdiff_t more = std::ranges::count(one, '\n');
    if (!text.empty() && lines + more > kMost) {
      ++left;
      continue;
    }
    lines += more;
    text += one;
  }
  if (left > 0) text += fmt::format("... and {} more\n", left);
  if (!whole) text += "\n";
  if (errors > 0 && warnings > 0)
    text += fmt::format("{}, {}\n", base::Counted(errors, "error"), base::Counted(warnings, "warning"));
  else if (errors > 0)
    text += base::Counted(errors, "error") + "\n";
  else if (warnings > 0)
    text += base::Counted(warnings, "warning") + "\n";
  PrintError(text);
}

verdict::ExitStatus WritePicture(const std::string& path, const std::string& svg, bool quiet) {
  const auto written = base::WriteFileAtomically(path, svg);
  if (!written.ok()) {
    PrintFailure(fmt::format("cannot write `{}`: {}", path, written.error().message));
    return verdict::ExitStatus::kRejected;
  }
  if (!quiet) Print(fmt::format("wrote {}\n", path));
  return verdict::ExitStatus::kEstablished;
}

std::string Folder(const std::string& path) {
  if (path.empty()) return {};
  const auto made = base::MakeFolders(path);
  return made.ok() ? "" : fmt::format("cannot use the folder `{}`: {}", path, made.error().message);
}

void PrintFailure(const std::string& message) {
  PrintError(fmt::format("rondo: {}\n", diag::Escaped(message)));
}

verdict::ExitStatus Refuse(const std::string& command, const std::string& file, bool json,
                           const diag::SourceSet& sources, const diag::Diagnostics& diagnostics,
                           const std::string& why) {
  constexpr auto kStatus = verdict::ExitStatus::kRejected;
  if (json) {
    PrintJson({{"command", command},
               {"file", file},
               {"status", kStatus},
               {"error", why},
               {"diagnostics", diag::RenderJson(sources, diagnostics)}});
  } else {
    PrintDiagnostics(sources, diagnostics);
    if (!why.empty()) PrintFailure(why);
  }
  return kStatus;
}

void PrintStatus(verdict::ExitStatus status) {
  if (status != verdict::ExitStatus::kEstablished) Print(fmt::format("exit {}\n", static_cast<int>(status)));
}

InterruptScope::InterruptScope(const base::StopToken& stop) {
  current = &stop;
  struct sigaction action {};
  action.sa_handler = OnInterrupt;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

InterruptScope::~InterruptScope() {
  ::signal(SIGINT, SIG_DFL);
  ::signal(SIGTERM, SIG_DFL);
  current = nullptr;
}

ProgressLine::ProgressLine() : on_(::isatty(STDERR_FILENO) != 0) {}

void ProgressLine::Show(const std::string& text) {
  if (!on_) return;
  shown_ = true;
  PrintError("\r\x1b[K" + text);
}

void ProgressLine::Clear() {
  if (shown_) PrintError("\r\x1b[K");
  shown_ = false;
}

}  // namespace rondo::driver
