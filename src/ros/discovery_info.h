#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ros/message.h"

/// What participants say of their nodes (rmw_dds_common/msg/ParticipantEntitiesInfo).
namespace rondo::ros {

/// Identifies a participant, reader or writer.
using Gid = std::array<uint8_t, 16>;

/// Lists the nodes of a participant.
struct DiscoveryInfo {
  struct Node {
    std::string node_namespace;  ///< at most 256 bytes, like `name`
    std::string name;
    std::vector<Gid> readers, writers;
  };
  Gid participant{};
  std::vector<Node> nodes;
};

/// Names and describes the topic on which that is said, and its type.
inline constexpr std::string_view kDiscoveryTopic = "ros_discovery_info";
extern const Message& kDiscoveryMessage;

/// Returns the message. `old_identities`: as ROS 2 Humble and before want it, with identities of 24 bytes, the last eight zero.
std::string Encoded(const DiscoveryInfo& info, bool old_identities);

/// Reads a message of either kind. Returns false, with `info` in some state, if it is none.
bool Decode(std::string_view bytes, DiscoveryInfo& info);

}  // namespace rondo::ros
