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
  constexpr int64_t kLatest = int64_t{1} << 60;
  if (stamp < 0 || stamp > kLatest) return;
  const int64_t before = stamp_.exchange(stamp);
  if (now_ > 0 && stamp < before) {
    shift_ += before - stamp;
    ++set_back_;
  }
  // Nobody takes a clock that stands at zero for one that was not heard.
  now_ = std::max<Time>(stamp + shift_, 1);
}

Time Clock::Now() const { return simulated_ ? now_.load() : transport::BootTime(); }

int64_t Clock::Stamp() const { return simulated_ ? stamp_.load() : WallTime(); }

}  // namespace rondo::platform
