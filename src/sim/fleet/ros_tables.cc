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

void ReadPorts(Tables& tables, const toml::table& table, FleetRos& ros) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const toml::table* port = node.as_table();
    const char* way = nullptr;
    for (const char* word : {"ros2", "nav2", "cmd_vel", "ackermann"}) {
      if (port == nullptr || !port->contains(word)) continue;
      if (way != nullptr)
        tables.Wrong(tables.At(node), fmt::format("`{}` has two topics: `{}` and `{}`", name, way, word));
      way = word;
    }
    if (way == nullptr) {
      tables.Wrong(
          tables.At(node),
          fmt::format(R"(`{}` needs a topic, as in {{ ros2 = "odom" }} or {{ cmd_vel = "cmd_vel" }})", name));
      continue;
    }
    tables.Known(*port, {"ros2", "nav2", "cmd_vel", "ackermann", "max_age", "stamped"}, "a port");
    FleetPort& p = ros.ports[name];
    p.span = tables.At(node);
    p.via = way == std::string("cmd_vel")     ? PortVia::kTwist
            : way == std::string("ackermann") ? PortVia::kAckermann
                                              : PortVia::kTopic;
    p.topic = Text(tables, *port, way, "\"odom\"");
    p.stamped = tables.Flag(*port, "stamped", false);
    p.max_age = tables.Number(*port, "max_age", 0, 1e-3, 1e4);
    if (!p.topic.empty() && !ros::IsName(p.topic))
      tables.Wrong(
          tables.At(*port->get(way)),
          "a topic has letters, digits, `_` and `/`; no part begins with a digit, and there is no `__`");
  }
}

}  // namespace

FleetRos ReadRos(Tables& tables, const toml::table& root) {
  FleetRos ros;
  if (const toml::table* t = tables.Table(root, "ros")) {
    tables.Known(*t, {"domain", "profile", "interface", "distribution", "frame"}, "`ros`");
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
  }
  if (const toml::table* ports = tables.Table(root, "ports")) ReadPorts(tables, *ports, ros);
  return ros;
}

}  // namespace rondo::sim
