#include "contracts/program_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "diag/render.h"
#include "verdict/verdict.h"

namespace rondo::contracts {

using verdict::Verdict;

namespace {

std::string Scope(const koord::ProveOptions& options) {
  return options.robots ? fmt::format("N = {}", *options.robots) : "every N >= 1";
}

const char* Word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved:
      return "ok";
    case Verdict::kRefuted:
    case Verdict::kNotInductive:
      return "FAIL";
    case Verdict::kConditional:
    case Verdict::kUnknown:
      return "?";
  }
  return "";
}

}  // namespace

std::string ProveHeader(const std::string& file, const koord::Report& report,
                        const koord::ProveOptions& options, size_t cached) {
  std::string text =
      fmt::format("{}: {}, {}", file, base::Counted(report.obligations, "obligation"), Scope(options));
  if (cached > 0) text += fmt::format(" ({} answers from the cache)", cached);
  return text + "\n";
}

std::string ProveTable(const koord::Report& report) {
  size_t name_width = 0;
  size_t cell_width = 0;
  for (const koord::Row& row : report.rows) {
    name_width = std::max(name_width, row.name.size());
    for (const koord::Cell& cell : row.cells) cell_width = std::max(cell_width, cell.column.size() + 5);
  }
  std::string text;
  for (const koord::Row& row : report.rows) {
    std::string line = fmt::format("  {:{}}", row.name, name_width);
    double seconds = 0;
    for (const koord::Cell& cell : row.cells) {
      line += fmt::format("  {:{}}", fmt::format("{} {}", cell.column, Word(cell.verdict)), cell_width);
      seconds += cell.seconds;
    }
    text += fmt::format("{} {:8.2f} s\n", line, seconds);
  }
  return text;
}

std::string ProveSummary(const koord::Report& report, const koord::ProveOptions& options) {
  std::string text = "\n";
  const std::string scope = options.robots ? fmt::format("for N = {}", *options.robots) : "for every N";
  for (const Verdict verdict : {Verdict::kProved, Verdict::kRefuted, Verdict::kNotInductive,
                                Verdict::kConditional, Verdict::kUnknown}) {
    std::vector<std::string> names;
    for (const koord::Row& row : report.rows) {
      if (row.verdict != verdict) continue;
      names.push_back(row.because.empty() ? row.name : fmt::format("{} ({})", row.name, row.because));
    }
    if (!names.empty())
      text += fmt::format("{}{}: {}\n", verdict::Name(verdict),
                          verdict == Verdict::kProved ? " " + scope : "", fmt::join(names, ", "));
  }
  if (!report.basis.assumed.empty())
    text += fmt::format("assumed: {}\n", fmt::join(report.basis.assumed, "; "));
  for (const verdict::Discharged& d : report.basis.proved)
    text += fmt::format("proved by {}: {} ({})\n", verdict::Name(d.by), d.claim, fmt::join(d.limits, "; "));
  if (!report.basis.unused.empty()) text += fmt::format("unused: {}\n", fmt::join(report.basis.unused, "; "));
  if (!report.unconstrained.empty())
    text += fmt::format("functions that may return anything: {}\n", fmt::join(report.unconstrained, ", "));
  if (options.cross_check != nullptr) {
    text += fmt::format(
        "cross-checked with {}: {} agree{}{}\n", options.cross_check->name(),
        base::Counted(report.cross_checked, "obligation"), report.cross_checked == 1 ? "s" : "",
        report.cross_unknown > 0 ? fmt::format(", {} undecided there", report.cross_unknown) : "");
  }
  if (report.interrupted) text += "interrupted: what is marked `?` was not decided\n";
  for (const std::string& problem : report.problems) text += fmt::format("could not write {}\n", problem);
  return text;
}

nlohmann::json ToJson(const koord::Report& report, const diag::SourceSet& sources) {
  nlohmann::json json = nlohmann::json::object();
  json["invariants"] = nlohmann::json::array();
  for (const koord::Row& row : report.rows) {
    nlohmann::json entry{{"name", row.name}, {"verdict", verdict::Name(row.verdict)}};
    if (row.span.file.valid()) entry["place"] = diag::SpanJson(sources, row.span);
    if (!row.because.empty()) entry["because"] = row.because;
    for (const koord::Cell& cell : row.cells) {
      nlohmann::json c{{"id", row.name + "/" + cell.column},
                       {"case", cell.column},
                       {"verdict", verdict::Name(cell.verdict)},
                       {"seconds", cell.seconds},
                       {"used", cell.core}};
      if (!cell.reason.empty()) c["reason"] = cell.reason;
      entry["obligations"].push_back(std::move(c));
    }
    json["invariants"].push_back(std::move(entry));
  }
  json["rests_on"] = verdict::ToJson(report.basis);
  json["unconstrained"] = report.unconstrained;
  json["cross_checked"] = report.cross_checked;
  return json;
}

}  // namespace rondo::contracts
