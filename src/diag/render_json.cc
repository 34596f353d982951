#include <nlohmann/json.hpp>

#include "diag/render.h"

namespace rondo::diag {

nlohmann::json SpanJson(const SourceSet& sources, Span span) {
  const Position begin = sources.Locate(span.file, span.begin);
  const Position end = sources.Locate(span.file, span.end);
  return {{"file", sources.path(span.file)},
          {"line", begin.line},
          {"column", begin.column},
          {"end_line", end.line},
          {"end_column", end.column}};
}

nlohmann::json RenderJson(const SourceSet& sources, const Diagnostic& d) {
  nlohmann::json result = d.span.file.valid() ? SpanJson(sources, d.span) : nlohmann::json::object();
  result["kind"] = Info(d.kind).id;
  result["severity"] = SeverityName(d.severity);
  result["message"] = d.message;
  if (!d.label.empty()) result["label"] = d.label;
  result["labels"] = nlohmann::json::array();
  for (const Label& label : d.labels) {
    nlohmann::json entry = SpanJson(sources, label.span);
    entry["message"] = label.message;
    result["labels"].push_back(std::move(entry));
  }
  result["notes"] = d.notes;
  result["help"] = d.helps;
  result["fixes"] = nlohmann::json::array();
  for (const FixIt& fix : d.fixes) {
    nlohmann::json entry = SpanJson(sources, fix.span);
    entry["replacement"] = fix.replacement;
    result["fixes"].push_back(std::move(entry));
  }
  return result;
}

nlohmann::json RenderJson(const SourceSet& sources, const Diagnostics& diagnostics) {
  nlohmann::json list = nlohmann::json::array();
  for (const Diagnostic& d : diagnostics.Sorted()) list.push_back(RenderJson(sources, d));
  return list;
}

}  // namespace rondo::diag
