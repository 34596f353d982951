#include "sim/draw/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "trace/reader.h"

namespace rondo::sim {

using nlohmann::json;

std::string TextOf(const json& record, const char* key) {
  const bool text = record.is_object() && record.contains(key) && record[key].is_string();
  return text ? record[key].get<std::string>() : std::string();
}

std::string TitleOf(const History& history) {
  return fmt::format("{}, {} robots, seed {}", TextOf(history.run, "program_name"), history.robots.size(),
                     history.run.contains("seed") ? history.run["seed"].dump() : "?");
}

base::Result<History> ReadHistory(std::string_view bytes) {
  History history;
  std::map<std::string, size_t, std::less<>> robots;
  std::string problem;
  const auto done = trace::ForEachMessage(bytes, [&](const trace::Message& m) {
    const double time = static_cast<double>(m.time) * 1e-9;
    if (m.encoding == "json") {
      json record = json::parse(m.bytes, nullptr, false);
      if (record.is_discarded() || !record.is_object()) {
        problem = "a record is no JSON";
        return false;
      }
      if (m.topic == "/rondo/event") history.events.push_back({time, std::move(record)});
      if (m.topic != "/rondo/run") return true;
      history.run = json::parse(m.bytes, nullptr, false);
      const json& list = history.run.contains("robots") ? history.run["robots"] : json::array();
      for (const json& robot : list.is_array() ? list : json::array()) {
        if (!robot.is_object() || !robot.contains("name") || !robot["name"].is_string() ||
            !robot.contains("radius") || !robot["radius"].is_number()) {
          problem = "the record of the run is damaged";
          return false;
        }
        robots[robot["name"].get<std::string>()] = history.robots.size();
        history.robots.push_back({robot["name"], robot["radius"], {}});
      }
      return true;
    }
    if (m.schema == trace::kPoseStamped.name && m.topic.size() > 6) {
      const auto it = robots.find(m.topic.substr(1, m.topic.size() - 6));
      trace::Pose pose;
      if (it == robots.end()) return true;
      if (!trace::ReadPose(m.bytes, pose)) {
        problem = "a pose is damaged";
        return false;
      }
      history.robots[it->second].poses.emplace_back(time, pose.position);
    }
    if (m.schema == trace::kOccupancyGrid.name) {
      if (!trace::ReadGrid(m.bytes, history.map)) {
        problem = "a map is damaged";
        return false;
      }
      history.known.emplace_back(
          time, static_cast<size_t>(std::count_if(history.map.cells.begin(), history.map.cells.end(),
                                                  [](int8_t c) { return c >= 0; })));
    }
    return true;
  });
  if (!done.ok()) return done.error();
  if (!problem.empty()) return base::Error{problem};
  if (TextOf(history.run, "format") != "rondo-trace/1")
    return base::Error{"this is no trace of Rondo's simulator"};
  return history;
}

}  // namespace rondo::sim
