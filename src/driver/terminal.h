#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "diag/render.h"
#include "verdict/verdict.h"

/// Talks to the user: standard output, standard error, progress and interrupts.
namespace rondo::driver {

/// Writes text to standard output. A reader that went away is not an error.
void Print(const std::string& text);
/// Writes an object of the published schema (docs/json.md), indented, to standard output: adds the version of the schema. Bytes that
/// are no UTF-8 become U+FFFD.
void PrintJson(nlohmann::json json);
/// Writes text to standard error, after what is already on its way to standard output.
void PrintError(const std::string& text);

/// Returns whether to use colours on standard error: if it is a terminal and NO_COLOR is not set.
diag::Colour ErrorColour();

/// Writes all diagnostics, sorted, to standard error, and a closing line that counts them.
void PrintDiagnostics(const diag::SourceSet& sources, const diag::Diagnostics& diagnostics);

/// Writes a picture to a file, as a whole or not at all; says so, unless `quiet`.
verdict::ExitStatus WritePicture(const std::string& path, const std::string& svg, bool quiet = false);

/// Makes the folder that a user names for what a verb writes, if it is not there. Returns what is wrong; nothing if nothing is, or no
/// folder is named.
std::string Folder(const std::string& path);

/// Writes `rondo: message` to standard error, for what went wrong outside any source file.
void PrintFailure(const std::string& message);

/// Says why a verb cannot do its work, as JSON or in words: the diagnostics, and `why` unless it is empty. Returns `kRejected`.
verdict::ExitStatus Refuse(const std::string& command, const std::string& file, bool json,
                           const diag::SourceSet& sources, const diag::Diagnostics& diagnostics,
                           const std::string& why);

/// Writes a line such as `exit 3`, for every status but success.
void PrintStatus(verdict::ExitStatus status);

/// Lets Ctrl-C request a stop through the token while it lives; a second Ctrl-C ends the process at once.
/// Only one may live at a time.
class InterruptScope {
 public:
  explicit InterruptScope(const base::StopToken& stop);
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  ~InterruptScope();
};

/// Shows a line that is overwritten in place; shows nothing if standard error is no terminal.
class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { Clear(); }
  /// Replaces the line, and `Clear` removes it.
  void Show(const std::string& text);
  void Clear();

 private:
  bool on_;
  bool shown_ = false;
};

}  // namespace rondo::driver
