#include "driver/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "driver/exit_status.h"

namespace rondo::driver {

void Print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void PrintJson(const nlohmann::json& json) {
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
  std::string text;
  size_t errors = 0;
  size_t warnings = 0;
  for (const diag::Diagnostic& d : diagnostics.Sorted()) {
    text += diag::RenderText(sources, d, ErrorColour()) + "\n";
    if (d.severity == diag::Severity::kError) ++errors;
    if (d.severity == diag::Severity::kWarning) ++warnings;
  }
  const auto count = [](size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  if (errors > 0 && warnings > 0)
    text += fmt::format("{}, {}\n", count(errors, "error"), count(warnings, "warning"));
  else if (errors > 0)
    text += count(errors, "error") + "\n";
  else if (warnings > 0)
    text += count(warnings, "warning") + "\n";
  PrintError(text);
}

nlohmann::json DiagnosticsToJson(const diag::SourceSet& sources, const diag::Diagnostics& diagnostics) {
  nlohmann::json list = nlohmann::json::array();
  for (const diag::Diagnostic& d : diagnostics.Sorted()) list.push_back(diag::RenderJson(sources, d));
  return list;
}

int WritePicture(const std::string& path, const std::string& svg, bool quiet) {
  const auto written = base::WriteFileAtomically(path, svg);
  if (!written.ok()) {
    PrintFailure(fmt::format("cannot write `{}`: {}", path, written.error().message));
    return kRejected;
  }
  if (!quiet) Print(fmt::format("wrote {}\n", path));
  return kEstablished;
}

void PrintFailure(const std::string& message) { PrintError(fmt::format("rondo: {}\n", message)); }

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
