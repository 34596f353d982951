#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

/// Talks DDS (Cyclone DDS 0.10), as nodes of ROS 2 do.
namespace rondo::dds {

/// Names what kind of network there is between robots.
enum class Profile : uint8_t {
  kLoopback,  ///< this machine only
  kLan,       ///< a network that carries multicast: robots find each other by it
  kWifi,  ///< a radio: robots are found at the addresses of `peers`, and nothing is sent to all but what finds them
};

/// Names the keys that a participant has: a folder as `ros2 security` makes them. All participants of a process have those of
/// the first: Cyclone DDS 0.10 looks at no other permissions.
struct Keys {
  std::string folder =
      {};  ///< with `cert.pem`, `key.pem`, `permissions.p7s` and so on; empty: there are none
  std::string enclave = "/";  ///< what ROS 2 calls it
};

/// Says which network a participant is in, and how it finds others there.
struct Network {
  uint32_t domain = 0;  ///< 0 to 232 (`ROS_DOMAIN_ID`)
  Profile profile = Profile::kLoopback;
  std::string interface = {};           ///< such as `wlan0`; empty: the library chooses
  std::vector<std::string> peers = {};  ///< addresses of other machines
  bool old_identities =
      false;  ///< ROS 2 Humble and before: identities of 24 bytes in what nodes say of themselves
  Keys keys = {};
  uint32_t lost_in_thousand = 0;  ///< for tests: so many packets of a thousand are not sent
};

/// Puts what the variables of ROS 2 say over what is given: `ROS_DOMAIN_ID`, `ROS_LOCALHOST_ONLY`,
/// `ROS_AUTOMATIC_DISCOVERY_RANGE`, `ROS_STATIC_PEERS`, `ROS_DISTRO`. @error if one has a value that it cannot have, or
/// forbids to find anybody.
base::Result<Network> WithEnvironment(Network network);

/// Returns the configuration of Cyclone DDS for a network, as XML.
std::string Configuration(const Network& network);

}  // namespace rondo::dds
