#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diag/kind.h"
#include "diag/source.h"

/// Diagnostics: what is wrong with the input of a user, where, and what would mend it.
namespace rondo::diag {

/// Marks a second place that matters, and says why.
struct Label {
  Span span;
  std::string message;
};

/// Describes an edit that would resolve the diagnostic: the text at `span` becomes `replacement`.
struct FixIt {
  Span span;
  std::string replacement;
};

/// Reports one cause, once. `message` is lower case, without full stop, with code in backticks. The members
/// below add a part each and return the diagnostic, so that calls can be chained.
struct Diagnostic {
  Kind kind;
  Severity severity;
  Span span;
  std::string message;
  std::string label;  ///< shown under the primary span
  std::vector<Label> labels;
  std::vector<std::string> notes;  ///< further facts; a note may have several lines, such as a table
  std::vector<std::string> helps;  ///< what the user might do, in words
  std::vector<FixIt> fixes;        ///< edits that a tool can make

  /// Sets the label under the primary span.
  Diagnostic& Under(std::string text);
  /// Adds a label at another place.
  Diagnostic& At(Span where, std::string text);
  Diagnostic& Note(std::string text);
  Diagnostic& Help(std::string text);
  Diagnostic& Fix(Span where, std::string replacement);
};

/// Collects what phases report, in the order of reporting. A second report of the same kind, at the same span
/// and with the same message, is dropped. Of each file the first `kMost` errors are kept, and so many warnings and notes; more
/// are counted.
class Diagnostics {
 public:
  static constexpr size_t kMost = 20;

  /// Adds a diagnostic with the severity of its kind. The reference stays valid until the next report; what
  /// is added to a report that was dropped is lost.
  Diagnostic& Report(Kind kind, Span span, std::string message);

  const std::vector<Diagnostic>& all() const { return diagnostics_; }
  /// Reports whether anything of severity kError was reported; warnings and notes do not count.
  bool has_errors() const { return errors_ > 0; }
  size_t errors() const { return errors_; }
  /// Returns how many were counted and not kept.
  size_t more() const { return more_; }

  /// Returns all diagnostics by file, then position; reports about no place come last, and then, if there are more than were
  /// kept, a note of how many (kFileMore).
  std::vector<Diagnostic> Sorted() const;

 private:
  std::vector<Diagnostic> diagnostics_;
  Diagnostic dropped_{};
  size_t errors_ = 0, more_ = 0;
  std::map<std::pair<FileId, bool>, size_t> of_file_;  // by file, and whether they are errors
};

}  // namespace rondo::diag
