#include "sim/draw/stage_history.h"

#include <algorithm>
#include <optional>

#include "sim/draw/history.h"
#include "trace/reader.h"
#include "trace/ros.h"

namespace rondo::sim {

using nlohmann::json;

namespace {

class Reader {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
 public:
  base::Result<StageHistory> Read(std::string_view bytes) {
    const auto done = trace::ForEachMessage(bytes, [&](const trace::Message& m) {
      const double time = static_cast<double>(m.time) * 1e-9;
      if (m.topic == "/rondo/run") return Run(m.bytes);
      if (m.topic == "/rondo/event") return Event(time, m.bytes);
      return m.schema != trace::kJointState.name || States(time, m);
    });
    if (!done.ok()) return done.error();
    if (!problem_.empty()) return base::Error{problem_};
    if (TextOf(history_.run, "engine") != "choreography")
      return base::Error{"this is no trace of a choreography"};
    for (StageHistory::Motion& m : history_.motions) m.to = std::max(m.from, m.to < 0 ? history_.end : m.to);
    return std::move(history_);
  }

 private:
  bool Damaged(const char* what) {
    problem_ = what;
    return false;
  }

  bool Run(std::string_view bytes) {
    history_.run = json::parse(bytes, nullptr, false);
    const json robots = history_.run.is_object() ? history_.run.value("robots", json::array()) : json();
    if (!robots.is_array()) return Damaged("the record of the run is damaged");
    for (const json& robot : robots) history_.robots.push_back(TextOf(robot, "name"));
    history_.states.resize(history_.robots.size());
    under_way_.resize(history_.robots.size());
    return true;
  }

  std::optional<size_t> Robot(std::string_view name) const {
    const auto it = std::ranges::find(history_.robots, name);
    if (it == history_.robots.end()) return std::nullopt;
    return static_cast<size_t>(it - history_.robots.begin());
  }

  bool Event(double time, std::string_view bytes) {
    const json event = json::parse(bytes, nullptr, false);
    if (!event.is_object()) return Damaged("a record is no JSON");
    const std::string kind = TextOf(event, "kind");
    history_.end = std::max(history_.end, time);
    if (kind == "end") history_.why = TextOf(event, "why");
    if (kind == "incident") history_.incidents.push_back({time, TextOf(event, "what")});
    if (kind == "message") {
      const auto from = Robot(TextOf(event, "from")), to = Robot(TextOf(event, "to"));
      if (!from || !to) return Damaged("a message is damaged");
      history_.messages.push_back({time, *from, *to, TextOf(event, "label")});
    }
    if (kind != "begins" && kind != "ends") return true;
    const auto robot = Robot(TextOf(event, "robot"));
    if (!robot) return Damaged("a motion is damaged");
    std::optional<size_t>& motion = under_way_[*robot];
    if (motion) history_.motions[*motion].to = time;
    motion.reset();
    if (kind == "ends") return true;
    motion = history_.motions.size();
    history_.motions.push_back({*robot, TextOf(event, "motion"), time, -1});
    return true;
  }

  bool States(double time, const trace::Message& m) {
    constexpr std::string_view kTopic = "/joint_states";
    if (!m.topic.ends_with(kTopic)) return true;
    const auto robot = Robot(m.topic.substr(1, m.topic.size() - kTopic.size() - 1));
    std::vector<std::string> names;
    std::vector<double> values;
    if (!robot || !trace::ReadJointState(m.bytes, names, values)) return Damaged("a state is damaged");
    auto& [at, states] = history_.states[*robot].emplace_back(time, std::map<std::string, double>{});
    for (size_t i = 0; i < names.size(); ++i) states[names[i]] = values[i];
    return true;
  }

  StageHistory history_;
  std::vector<std::optional<size_t>> under_way_;  // by robot
  std::string problem_;
};

}  // namespace

base::Result<StageHistory> ReadStageHistory(std::string_view bytes) { return Reader().Read(bytes); }

}  // namespace rondo::sim
