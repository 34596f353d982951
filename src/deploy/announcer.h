#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dds/participant.h"

namespace rondo::deploy {

/// Tells people what a robot does: on `/rosout`, and by a function. Used by one thread.
class Announcer {
 public:
  /// Are levels of rcl_interfaces/Log.
  enum class Level : uint8_t { kInfo = 20, kWarning = 30, kError = 40 };

  /// @param space  the namespace of the robot, without `/`.
  /// @param tell  may be empty.
  Announcer(std::string space, std::function<void(const std::string&)> tell)
      : name_(std::move(space) + ".rondo"), tell_(std::move(tell)) {}

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);
  /// @param stamp  nanoseconds since 1970, or what `/clock` says.
  void Tell(const std::string& text, Level level, int64_t stamp);

 private:
  std::string name_;
  std::function<void(const std::string&)> tell_;
  std::unique_ptr<dds::Publisher> rosout_;
};

}  // namespace rondo::deploy
