#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace rondo::trace {

struct Message {
  std::string_view topic;
  std::string_view schema;
  std::string_view encoding;
  uint64_t time;  ///< nanoseconds
  std::string_view bytes;
};

/// Calls `visit` for each message in the order of the file, until it returns false. Chunks must not be
/// compressed (Rondo's are not). @error with the offset, if the bytes are no complete MCAP file.
base::Result<bool> ForEachMessage(std::string_view file, const std::function<bool(const Message&)>& visit);

/// The bytes of a trace. @error when it cannot be read, or is larger than 4 GiB.
base::Result<std::string> ReadTrace(const std::string& path);

}  // namespace rondo::trace
