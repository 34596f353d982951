#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diag/diagnostic.h"

/// Diagnostics as text for people and as JSON for tools.
namespace rondo::diag {

/// Says whether text has ANSI colours; the caller decides from the terminal and NO_COLOR.
enum class Colour : bool { kOff, kOn };

/// Returns the diagnostic with its source lines, carets, labels, notes, helps and fixes, ending in a newline.
std::string RenderText(const SourceSet& sources, const Diagnostic& diagnostic, Colour colour);

/// Returns the diagnostic as one line, without its sources: `error: a.koord:3:1: message [kind]`.
std::string RenderLine(const SourceSet& sources, const Diagnostic& diagnostic);

/// Returns {kind, severity, message, file, line, column, end_line, end_column, label, labels, notes, help,
/// fixes}; file and positions are absent when the diagnostic is not about one place.
nlohmann::json RenderJson(const SourceSet& sources, const Diagnostic& diagnostic);

/// Returns all diagnostics as an array, sorted, each as above.
nlohmann::json RenderJson(const SourceSet& sources, const Diagnostics& diagnostics);

/// Returns {file, line, column, end_line, end_column} of a valid span.
nlohmann::json SpanJson(const SourceSet& sources, Span span);

}  // namespace rondo::diag
