#pragma once

#include <string>
#include <vector>

/// What DDS Security 1.1 lets whom do, as XML: whoever signs it decides.
namespace rondo::security {

/// Is what a process is, and may do, in every domain.
struct Enclave {
  std::string name;                                ///< such as `/bot0`: the subject of its certificate
  std::vector<std::string> publishes, subscribes;  ///< topics as they are named on the wire
};

/// Returns the rules of a fleet (governance): nobody takes part without a key, everything is encrypted, and only who may
/// sends and hears. They are those of ROS 2 (sros2), so that its nodes can take part. Domains above 230 have no rules: Cyclone DDS
/// cannot read them.
std::string Governance();

/// Returns what one process may do (permissions): what it lists, and nothing else, from a day ago on for ten years.
/// @param now  seconds since 1970.
std::string Permissions(const Enclave& enclave, long now);

}  // namespace rondo::security
