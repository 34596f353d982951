#pragma once

#include <string>
#include <string_view>

#include "ros/cdr.h"

/// Messages as ROS 2 has them. Lengths in metres, angles in radians, axes as REP-103 says.
namespace rondo::ros {

/// Describes a type of messages.
struct Message {
  std::string_view name;        ///< such as `geometry_msgs/msg/Twist`
  std::string_view hash;        ///< RIHS01 (REP-2011), as discovery carries it
  std::string_view definition;  ///< `ros2msg`: the definition, and behind it those that it uses
};

/// Returns a message as CDR with its header of four bytes.
template <class M>
std::string Serialised(const M& message) {
  CdrWriter writer;
  Encode(writer, message);
  return writer.Take();
}

/// Reads a message from CDR. Returns false, with `message` in some state, if the bytes are none.
template <class M>
bool Parse(std::string_view bytes, M& message) {
  CdrReader reader(bytes);
  Decode(reader, message);
  return reader.Complete();
}

}  // namespace rondo::ros
