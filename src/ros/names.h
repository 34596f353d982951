#pragma once

#include <string>
#include <string_view>

/// Names of ROS 2, and what they are on the wire (DDS).
namespace rondo::ros {

/// Reports whether this is a name of a topic or a namespace: letters, digits, `_` and `/`, no part empty or with a digit in
/// front, no `__`. It may begin with `/` or not.
bool IsName(std::string_view name);

/// Returns the full name of a topic: `name` itself if it begins with `/`, else behind the namespace of the node. Both are
/// names; a namespace is "" or "/" for the root.
std::string FullName(std::string_view node_namespace, std::string_view name);

/// Returns a text as a part of a name: what may not stand in one is `_`.
std::string Plain(std::string_view text);

/// Returns the name of the topic on the wire: `/robot1/odom` is `rt/robot1/odom`.
std::string WireTopic(std::string_view full_name);
/// Returns the name of a type on the wire: `geometry_msgs/msg/Twist` is `geometry_msgs::msg::dds_::Twist_`.
std::string WireType(std::string_view type);

/// Return what a topic or type is called in ROS; empty if it is none of ROS.
std::string TopicOfWire(std::string_view wire);
std::string TypeOfWire(std::string_view wire);

}  // namespace rondo::ros
