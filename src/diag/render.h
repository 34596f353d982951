#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diag/diagnostic.h"

namespace rondo::diag {

/// ANSI colours or none; the caller decides from the terminal and NO_COLOR.
enum class Colour : bool { kOff, kOn };

/// The diagnostic with its source lines, carets, labels, notes, helps and fixes, ending in a newline.
std::string RenderText(const SourceSet& sources, const Diagnostic& diagnostic, Colour colour);

/// {kind, severity, message, file, line, column, end_line, end_column, label, labels, notes, help, fixes};
/// file and positions are absent when the diagnostic is not about one place.
nlohmann::json RenderJson(const SourceSet& sources, const Diagnostic& diagnostic);

/// All diagnostics, sorted, each as above.
nlohmann::json RenderJson(const SourceSet& sources, const Diagnostics& diagnostics);

/// {file, line, column, end_line, end_column} of a valid span.
nlohmann::json SpanJson(const SourceSet& sources, Span span);

}  // namespace rondo::diag
