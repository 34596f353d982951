#include "platform/clock.h"

#include <algorithm>

#include "platform/topics.h"
#include "ros/rosgraph_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

base::Result<bool> Clock::Begin(dds::Participant& participant, size_t node) {
  if (!simulated_) return true;
  auto subscription = participant.Subscribe(node, "/clock", ros::rosgraph_msgs::Clock::kMessage,
                                            {.reliable = false, .depth = 1},
                                            [this](std::string_view bytes, const dds::Received&) {
                                              ros::rosgraph_msgs::Clock m;
                                              if (ros::Parse(bytes, m))
                                                Hear(m.clock.sec * 1'000'000'000LL + m.clock.nanosec);
                                            });
  if (!subscription.ok()) return subscription.error();
  subscription_ = std::move(subscription).value();
  return true;
}

// One thread of the library calls it at a time.
void Clock::Hear(int64_t stamp) {
  const int64_t before = stamp_.exchange(stamp);
  // Time that nobody can say anything about does not pass: none before the first word, and none when it is set back.
  if (now_ == 0)
    now_ = 1;
  else
    now_ += std::max<int64_t>(0, stamp - before);
}

Time Clock::Now() const { return simulated_ ? now_.load() : transport::BootTime(); }

int64_t Clock::Stamp() const { return simulated_ ? stamp_.load() : WallTime(); }

}  // namespace rondo::platform
