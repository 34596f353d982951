#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/result.h"

/// Traces that are read back: for plots, replays and comparisons.
namespace rondo::trace {

/// Is one message of a trace. Its views point into the file.
struct Message {
  std::string_view topic;
  std::string_view schema;    ///< such as `geometry_msgs/msg/PoseStamped`
  std::string_view encoding;  ///< of `bytes`: `cdr` or `json`
  uint64_t time;              ///< nanoseconds since the start of the run
  std::string_view bytes;
};

/// Calls `visit` for each message in the order of the file, until it returns false. Chunks must not be
/// compressed (Rondo's are not). Messages of a chunk whose checksum is another are not visited.
///
/// @error with the offset in bytes, if the file is not a complete MCAP file (MCAP specification, version 0), or a checksum
/// in it is not that of its bytes.
base::Result<bool> ForEachMessage(std::string_view file, const std::function<bool(const Message&)>& visit);
/// Does the same with a file whose writer was killed: as far as its records are whole. @error if it is no MCAP file, or
/// a whole record is damaged.
base::Result<bool> ForEachMessageLeft(std::string_view file,
                                      const std::function<bool(const Message&)>& visit);

/// Returns the bytes of a trace. @error when it cannot be read, or is larger than 4 GiB.
base::Result<std::string> ReadTrace(const std::string& path);

}  // namespace rondo::trace
