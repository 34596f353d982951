#pragma once

#include <string>
#include <vector>

#include "diag/kind.h"
#include "diag/source.h"

namespace rondo::diag {

/// A second place that matters, and why.
struct Label {
  Span span;
  std::string message;
};

/// An edit that would resolve the diagnostic.
struct FixIt {
  Span span;
  std::string replacement;
};

/// One cause, reported once. `message` is lower case, without full stop, with code in backticks.
struct Diagnostic {
  Kind kind;
  Severity severity;
  Span span;
  std::string message;
  std::string label;  ///< shown under the primary span
  std::vector<Label> labels;
  std::vector<std::string> notes;  ///< may have several lines: tables
  std::vector<std::string> helps;
  std::vector<FixIt> fixes;

  Diagnostic& Under(std::string text);
  Diagnostic& At(Span where, std::string text);
  Diagnostic& Note(std::string text);
  Diagnostic& Help(std::string text);
  Diagnostic& Fix(Span where, std::string replacement);
};

/// Where phases report. Keeps the order of reporting; a second report of the same kind at the same span is
/// dropped.
class Diagnostics {
 public:
  /// The reference stays valid until the next report.
  Diagnostic& Report(Kind kind, Span span, std::string message);

  const std::vector<Diagnostic>& all() const { return diagnostics_; }
  bool has_errors() const { return errors_ > 0; }
  size_t errors() const { return errors_; }

  /// By file, then position; reports about no place come last.
  std::vector<Diagnostic> Sorted() const;

 private:
  std::vector<Diagnostic> diagnostics_;
  Diagnostic dropped_{};
  size_t errors_ = 0;
};

}  // namespace rondo::diag
