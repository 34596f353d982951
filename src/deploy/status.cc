#include "deploy/status.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "platform/topics.h"

namespace rondo::deploy {

namespace {

constexpr std::string_view kName = "rondo: ";
enum Level : uint8_t { kOk = 0, kWarning = 1, kError = 2 };

uint64_t Whole(const std::string& text) { return std::strtoull(text.c_str(), nullptr, 10); }

}  // namespace

ros::diagnostic_msgs::DiagnosticArray MessageOf(const RobotStatus& s, int64_t stamp) {
  ros::diagnostic_msgs::DiagnosticArray array;
  array.header = platform::HeaderOf("", stamp);
  auto& d = array.status.emplace_back();
  d.name = std::string(kName) + s.robot;
  d.hardware_id = s.robot;
  d.level = kOk;
  d.message = fmt::format("round {}", s.round);
  const auto say = [&](uint8_t level, std::string message) {
    if (level <= d.level) return;
    d.level = level;
    d.message = std::move(message);
  };
  if (s.phase == "halted") say(kError, "it lost the others and does not act any more");
  if (s.foreign > 0) say(kError, "somebody runs another program, specification or fleet file");
  if (!s.sensors.empty()) say(kError, s.sensors);
  if (!s.unheard.empty()) say(kWarning, fmt::format("does not hear {}", fmt::join(s.unheard, ", ")));
  if (!s.active && s.phase != "waiting") say(kWarning, "it does not act");
  const auto value = [&](const char* key, std::string text) { d.values.push_back({key, std::move(text)}); };
  value("program", s.program);
  value("phase", s.phase);
  value("agreement", s.agreement);
  value("epoch", fmt::to_string(s.epoch));
  value("round", fmt::to_string(s.round));
  value("active", s.active ? "true" : "false");
  value("median_ms", fmt::format("{:.3f}", s.median));
  value("p99_ms", fmt::format("{:.3f}", s.p99));
  value("fallbacks", fmt::to_string(s.fallbacks));
  value("blind", fmt::to_string(s.blind));
  value("late", fmt::to_string(s.late));
  value("refused", fmt::to_string(s.refused));
  value("foreign", fmt::to_string(s.foreign));
  value("strange", fmt::to_string(s.strange));
  value("sensors", s.sensors);
  value("unheard", fmt::format("{}", fmt::join(s.unheard, " ")));
  return array;
}

std::vector<RobotStatus> StatusesOf(const ros::diagnostic_msgs::DiagnosticArray& message) {
  std::vector<RobotStatus> all;
  for (const auto& d : message.status) {
    if (!d.name.starts_with(kName)) continue;
    std::map<std::string, std::string> values;
    for (const auto& v : d.values) values[v.key] = v.value;
    RobotStatus& s = all.emplace_back();
    s.robot = d.name.substr(kName.size());
    s.program = values["program"];
    s.phase = values["phase"];
    s.agreement = values["agreement"];
    s.epoch = Whole(values["epoch"]);
    s.round = Whole(values["round"]);
    s.active = values["active"] == "true";
    s.median = std::strtod(values["median_ms"].c_str(), nullptr);
    s.p99 = std::strtod(values["p99_ms"].c_str(), nullptr);
    s.fallbacks = Whole(values["fallbacks"]);
    s.blind = Whole(values["blind"]);
    s.late = Whole(values["late"]);
    s.refused = Whole(values["refused"]);
    s.foreign = Whole(values["foreign"]);
    s.strange = Whole(values["strange"]);
    s.sensors = values["sensors"];
    std::istringstream names(values["unheard"]);
    for (std::string name; names >> name;) s.unheard.push_back(name);
  }
  return all;
}

}  // namespace rondo::deploy
