#include "sim/fleet/ros_tables.h"

#include <fmt/format.h>

#include "ros/names.h"

namespace rondo::sim {

namespace {

std::string Text(Tables& tables, const toml::table& table, const char* name, const char* example) {
  const toml::node* node = table.get(name);
  if (node == nullptr) return {};
  const auto text = node->value<std::string>();
  if (!text || text->empty())
    tables.Wrong(tables.At(*node), fmt::format("`{}` must be a text, as in {}", name, example));
  return text.value_or("");
}

struct Way {
  const char* word;
  PortVia via;
  std::vector<std::string> more;  // what may stand beside it
};

const std::vector<Way>& Ways() {
  static const std::vector<Way> ways = {
      {"ros2", PortVia::kTopic, {"max_age", "reliable", "transient_local", "depth"}},
      {"nav2", PortVia::kNav2, {}},
      {"cmd_vel", PortVia::kTwist, {"stamped", "reliable", "depth"}},
      {"ackermann", PortVia::kAckermann, {"reliable", "depth"}},
      {"pose", PortVia::kPose, {"with_covariance", "max_age", "reliable", "transient_local", "depth"}},
      {"tf", PortVia::kTransform, {"max_age"}},
      {"joint_states", PortVia::kJointStates, {"joint", "max_age", "reliable", "transient_local", "depth"}},
      {"joint_trajectory", PortVia::kJointTrajectory, {"joint", "within", "reliable", "depth"}},
      {"px4", PortVia::kPx4, {"max_age", "system"}},
      {"adapter", PortVia::kAdapter, {"max_age", "with"}}};
  return ways;
}

void ReadPort(Tables& tables, const std::string& name, const Way& way, const toml::table& table,
              FleetPort& p) {
  std::vector<std::string> known = way.more;
  known.emplace_back(way.word);
  tables.Known(table, known, fmt::format("a port by `{}`", way.word));
  p.via = way.via;
  p.topic = Text(tables, table, way.word, "\"odom\"");
  p.stamped = tables.Flag(table, "stamped", false);
  p.with_covariance = tables.Flag(table, "with_covariance", false);
  p.max_age = tables.Number(table, "max_age", 0, 1e-3, 1e4);
  p.joint = Text(tables, table, "joint", "\"elbow\"");
  p.within = tables.Number(table, "within", 0, 1e-3, 1e4);
  p.system = static_cast<int>(tables.Whole(table, "system", 0, 1, 255));
  p.options = Text(tables, table, "with", "\"/dev/ttyUSB0\"");
  for (const auto& [word, flag] :
       {std::pair("reliable", &p.reliable), {"transient_local", &p.transient_local}}) {
    if (table.contains(word)) *flag = tables.Flag(table, word, false);
  }
  if (table.contains("depth")) p.depth = static_cast<uint32_t>(tables.Whole(table, "depth", 10, 1, 10'000));
  const bool joints = p.via == PortVia::kJointStates || p.via == PortVia::kJointTrajectory;
  if (joints && p.joint.empty())
    tables.Wrong(p.span, fmt::format("`{}` needs the name of its joint, as in joint = \"elbow\"", name));
  if (p.via != PortVia::kAdapter && !p.topic.empty() && !ros::IsName(p.topic))
    tables.Wrong(
        tables.At(*table.get(way.word)),
        "a topic has letters, digits, `_` and `/`; no part begins with a digit, and there is no `__`");
}

void ReadPorts(Tables& tables, const toml::table& table, FleetRos& ros) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const toml::table* port = node.as_table();
    std::vector<const Way*> ways;
    for (const Way& one : Ways()) {
      if (port != nullptr && port->contains(one.word)) ways.push_back(&one);
    }
    if (ways.empty()) {
      tables.Wrong(
          tables.At(node),
          fmt::format(R"(`{}` needs a topic, as in {{ ros2 = "odom" }} or {{ cmd_vel = "cmd_vel" }})", name));
      continue;
    }
    if (ways.size() > 1) {
      tables.Wrong(tables.At(node),
                   fmt::format("`{}` has two topics: `{}` and `{}`", name, ways[0]->word, ways[1]->word));
      continue;
    }
    FleetPort& p = ros.ports[name];
    p.span = tables.At(node);
    ReadPort(tables, name, *ways[0], *port, p);
  }
}

}  // namespace

FleetRos ReadRos(Tables& tables, const toml::table& root) {
  FleetRos ros;
  if (const toml::table* t = tables.Table(root, "ros")) {
    tables.Known(*t, {"domain", "profile", "interface", "distribution", "frame", "use_sim_time", "keys"},
                 "`ros`");
    ros.network.domain = static_cast<uint32_t>(tables.Whole(*t, "domain", 0, 0, 232));
    const std::string profile = tables.Word(*t, "profile", "loopback", {"loopback", "lan", "wifi"});
    ros.network.profile = profile == "lan"    ? dds::Profile::kLan
                          : profile == "wifi" ? dds::Profile::kWifi
                                              : dds::Profile::kLoopback;
    ros.network.interface = Text(tables, *t, "interface", "\"wlan0\"");
    ros.network.old_identities = tables.Word(*t, "distribution", "jazzy",
                                             {"foxy", "galactic", "humble", "iron", "jazzy", "kilted",
                                              "rolling"}) < std::string("iron");
    if (t->contains("frame")) ros.frame = Text(tables, *t, "frame", "\"map\"");
    ros.use_sim_time = tables.Flag(*t, "use_sim_time", false);
    ros.keys = Text(tables, *t, "keys", "\"keys\"");
  }
  if (const toml::table* ports = tables.Table(root, "ports")) ReadPorts(tables, *ports, ros);
  return ros;
}

}  // namespace rondo::sim
