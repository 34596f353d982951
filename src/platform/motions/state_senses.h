#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "platform/motions/body_topics.h"

namespace rondo::platform {

/// Hears where robots are, and what signals say. Thread-safe.
class StateSenses {
 public:
  /// @param bodies   the robots that are heard.
  /// @param signals  of the robot itself, and of the environment.
  /// @param max_age  seconds after which a robot is no longer where it was said to be.
  StateSenses(std::vector<BodyTopics> bodies, const std::vector<Signal>& signals, double max_age);

  /// Begins to listen. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  /// Says, for people, what was never heard, or too long ago; empty if all is well.
  std::string Unusable() const;
  /// Writes what was heard last over the values of a scene: of one of the bodies, or of all signals. Headings begin within their
  /// ranges, and are followed from there on.
  void Read(size_t body, std::vector<double>& scene) const;
  void ReadSignals(std::vector<double>& scene) const;
  /// Returns when the oldest part was heard of what is known of a body: CLOCK_BOOTTIME, nanoseconds.
  int64_t Heard(size_t body) const;

 private:
  struct Source {
    std::string topic;
    int64_t heard = 0;  // CLOCK_BOOTTIME, nanoseconds; 0: never
  };
  struct Value {
    size_t place;
    double value = 0;
    size_t source;
    bool turns = false;
  };
  using Write = std::function<bool(std::string_view bytes)>;
  base::Result<bool> Listen(dds::Participant& participant, size_t node, size_t source,
                            const ros::Message& type, const ros::Qos& qos, const Write& write);

  const std::vector<BodyTopics> bodies_;
  const double max_age_;
  mutable std::mutex mutex_;
  std::vector<Source> sources_;
  std::vector<std::vector<Value>> values_;  // by body, and last the signals
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace rondo::platform
