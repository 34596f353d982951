#include "deploy/echo.h"

#include "platform/topics.h"
#include "ros/rondo_msgs.h"
#include "runtime/codec/bytes.h"

namespace rondo::deploy {

using ros::rondo_msgs::Datagram;

EchoTopics EchoTopicsOf(const sim::Fleet& fleet, size_t robot) {
  const std::string space = "/" + fleet.robots[robot].node_namespace;
  return {space + "/rondo/ask", space + "/rondo/answer"};
}

const ros::Message& EchoMessage() { return Datagram::kMessage; }

std::string Encoded(const Echo& echo) {
  Datagram m;
  m.to = echo.number;
  runtime::codec::Writer writer(m.bytes);
  writer.Fixed(static_cast<uint64_t>(echo.asked));
  writer.Fixed(static_cast<uint64_t>(echo.answered));
  return ros::Serialised(m);
}

std::optional<Echo> Decoded(std::string_view bytes) {
  Datagram m;
  if (!ros::Parse(bytes, m)) return std::nullopt;
  runtime::codec::Reader reader(m.bytes);
  Echo echo{m.to, static_cast<int64_t>(reader.Fixed()), static_cast<int64_t>(reader.Fixed())};
  if (!reader.Complete()) return std::nullopt;
  return echo;
}

std::optional<std::string> AnswerTo(std::string_view question) {
  auto echo = Decoded(question);
  if (!echo || echo->answered != 0) return std::nullopt;
  echo->answered = platform::WallTime();
  return Encoded(*echo);
}

}  // namespace rondo::deploy
