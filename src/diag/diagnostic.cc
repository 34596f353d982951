#include "diag/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace rondo::diag {

Diagnostic& Diagnostic::Under(std::string text) {
  label = std::move(text);
  return *this;
}
Diagnostic& Diagnostic::At(Span where, std::string text) {
  labels.push_back({where, std::move(text)});
  return *this;
}
Diagnostic& Diagnostic::Note(std::string text) {
  notes.push_back(std::move(text));
  return *this;
}
Diagnostic& Diagnostic::Help(std::string text) {
  helps.push_back(std::move(text));
  return *this;
}
Diagnostic& Diagnostic::Fix(Span where, std::string replacement) {
  fixes.push_back({where, std::move(replacement)});
  return *this;
}

Diagnostic& Diagnostics::Report(Kind kind, Span span, std::string message) {
  Diagnostic fresh{kind, Info(kind).severity, span, std::move(message), {}, {}, {}, {}, {}};
  const auto same = [&](const Diagnostic& d) {
    return d.kind == fresh.kind && d.span == fresh.span && d.message == fresh.message;
  };
  if (std::any_of(diagnostics_.begin(), diagnostics_.end(), same)) {
    dropped_ = std::move(fresh);
    return dropped_;
  }
  const bool error = fresh.severity == Severity::kError;
  if (error) ++errors_;
  if (++of_file_[{span.file, error}] > kMost && span.file.valid()) {
    ++more_;
    dropped_ = std::move(fresh);
    return dropped_;
  }
  diagnostics_.push_back(std::move(fresh));
  return diagnostics_.back();
}

std::vector<Diagnostic> Diagnostics::Sorted() const {
  std::vector<Diagnostic> result = diagnostics_;
  const auto key = [](const Diagnostic& d) { return std::tuple(d.span.file.value, d.span.begin); };
  std::stable_sort(result.begin(), result.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return key(a) < key(b); });
  if (more_ > 0)
    result.push_back({Kind::kFileMore,
                      Info(Kind::kFileMore).severity,
                      {},
                      fmt::format("there are {} more, which are not shown", more_),
                      {},
                      {},
                      {},
                      {},
                      {}});
  return result;
}

}  // namespace rondo::diag
