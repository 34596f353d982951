#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "dds/participant.h"
#include "transport/transport.h"

/// Carries datagrams between robots by DDS, best effort: the protocol repeats what is lost.
namespace rondo::transport::dds {

/// Says who a robot is, and who the others are.
struct Fleet {
  std::string name;                 ///< of the program: a part of a ROS name; topics are `/rondo/NAME/...`
  std::vector<std::string> robots;  ///< their names, parts of ROS names
  uint32_t self = 0;
};

/// Returns the topic of what a robot is told, in full; `whom`: its name, or `all`.
std::string FramesTopic(const std::string& fleet, const std::string& whom);

/// Returns the way from and to one robot. The thread that uses it sends by itself: writers keep nothing for anybody, and the
/// sockets of the library do not block. Threads of the library receive (docs/adr/0025-threads-of-a-robot.md).
/// @param participant  outlives it; `node`: of that participant.
/// @error in the words of the library.
base::Result<std::unique_ptr<Transport>> Connect(rondo::dds::Participant& participant, size_t node,
                                                 const Fleet& fleet);

}  // namespace rondo::transport::dds
