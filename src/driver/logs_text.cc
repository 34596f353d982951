#include "driver/logs_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"

namespace rondo::driver {

using verdict::ExitStatus;

double Quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))];
}

std::string LogsText(const deploy::LogsReport& report) {
  std::string text = fmt::format("  {}", base::Counted(report.rounds, "round"));
  if (!report.waits.empty()) {
    text += fmt::format(
        "; a round is final after {:.3g} ms (half of them), {:.3g} ms (99 of 100), {:.3g} ms (all)",
        1e3 * Quantile(report.waits, 0.5), 1e3 * Quantile(report.waits, 0.99), 1e3 * report.waits.back());
  }
  text += "\n";
  if (report.explained > 0 && report.findings.empty())
    text += fmt::format("  {} of the program, as the robots logged them\n",
                        base::Counted(report.explained, "round"));
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < report.story.size() && i < kMost; ++i)
    text += fmt::format("  {:9.3f} s  {}\n", report.story[i].first, report.story[i].second);
  if (report.story.size() > kMost)
    text += fmt::format("  and {} more: `--json` has them all\n", report.story.size() - kMost);
  for (size_t i = 0; i < report.findings.size() && i < kMost; ++i)
    text +=
        fmt::format("  wrong: {} ({})\n", report.findings[i].text, history::Name(report.findings[i].wrong));
  if (report.findings.size() > kMost)
    text += fmt::format("  and {} more: `--json` has them all\n", report.findings.size() - kMost);
  for (const sim::Violation& v : report.violations) {
    text += fmt::format("  {}{}: violated in {}, first after {:.3f} s\n", v.what,
                        v.robot < 0 ? "" : fmt::format(" by robot {}", v.robot),
                        base::Counted(v.count, "state"), v.first);
  }
  for (const std::string& what : report.unchecked) text += fmt::format("  not checked: {}\n", what);
  return text;
}

nlohmann::json LogsJson(const deploy::LogsReport& report) {
  nlohmann::json findings = nlohmann::json::array(), violations = nlohmann::json::array(),
                 story = nlohmann::json::array();
  for (const auto& f : report.findings)
    findings.push_back({{"wrong", history::Name(f.wrong)}, {"text", f.text}, {"line", f.entry}});
  for (const sim::Violation& v : report.violations)
    violations.push_back({{"what", v.what}, {"robot", v.robot}, {"first", v.first}, {"count", v.count}});
  for (const auto& [time, what] : report.story) story.push_back({{"time", time}, {"what", what}});
  nlohmann::json json{{"rounds", report.rounds},  {"explained", report.explained}, {"lines", report.lines},
                      {"length", report.length},  {"fallbacks", report.fallbacks}, {"findings", findings},
                      {"violations", violations}, {"unchecked", report.unchecked}, {"happenings", story},
                      {"wait", nullptr}};
  if (!report.waits.empty()) {
    json["wait"] = {{"median", Quantile(report.waits, 0.5)},
                    {"p99", Quantile(report.waits, 0.99)},
                    {"max", report.waits.back()}};
  }
  return json;
}

ExitStatus LogsStatus(const deploy::LogsReport& report) {
  if (!report.findings.empty() || !report.violations.empty()) return ExitStatus::kRejected;
  return report.unchecked.empty() ? ExitStatus::kEstablished : ExitStatus::kUndecided;
}

}  // namespace rondo::driver
