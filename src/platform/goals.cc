#include "platform/goals.h"

namespace rondo::platform {

namespace {

constexpr int64_t kSlack = 500'000'000;  // nanoseconds by which clocks may differ

int64_t AcceptedAt(const ros::action_msgs::GoalStatus& status) {
  const auto& stamp = status.goal_info.stamp;
  return stamp.sec * 1'000'000'000LL + stamp.nanosec;
}

}  // namespace

void Goals::Begin(int64_t stamp) {
  since_ = stamp;
  if (known_.size() >= kMost) known_.clear();
  if (own_) known_.insert(*own_);
  own_.reset();
  reached_ = false;
}

void Goals::Hear(const ros::action_msgs::GoalStatusArray& message) {
  constexpr int kSucceeded = 4;
  // The latest that was accepted counts: an order that is given twice begins two goals.
  const ros::action_msgs::GoalStatus* latest = nullptr;
  for (const auto& status : message.status_list) {
    const Id id = status.goal_info.goal_id.uuid;
    if (known_.contains(id)) continue;
    // Before the first order, and whatever is there when it is given, nobody of us began.
    if (!reached_) {
      if (known_.size() < kMost) known_.insert(id);
      continue;
    }
    if (AcceptedAt(status) < since_ - kSlack) continue;
    if (latest == nullptr || AcceptedAt(*latest) < AcceptedAt(status)) latest = &status;
  }
  if (latest == nullptr) return;
  // What it replaces is over.
  for (const auto& status : message.status_list) {
    if (&status != latest && known_.size() < kMost) known_.insert(status.goal_info.goal_id.uuid);
  }
  own_ = latest->goal_info.goal_id.uuid;
  reached_ = latest->status == kSucceeded;
}

}  // namespace rondo::platform
