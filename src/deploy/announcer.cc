#include "deploy/announcer.h"

#include "platform/topics.h"
#include "ros/rcl_interfaces.h"

namespace rondo::deploy {

base::Result<bool> Announcer::Begin(dds::Participant& participant, size_t node) {
  auto rosout = participant.Publish(node, "/rosout", ros::rcl_interfaces::Log::kMessage, ros::kLog);
  if (!rosout.ok()) return rosout.error();
  rosout_ = std::move(rosout).value();
  return true;
}

void Announcer::Tell(const std::string& text, Level level, int64_t stamp) {
  ros::rcl_interfaces::Log m;
  m.stamp = platform::StampOf(stamp);
  m.level = static_cast<uint8_t>(level);
  m.name = name_;
  m.msg = text;
  (void)rosout_->Publish(m).ok();
  if (tell_) tell_(text);
}

}  // namespace rondo::deploy
