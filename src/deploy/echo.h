#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ros/message.h"
#include "ros/qos.h"
#include "sim/fleet/fleet.h"

/// Questions that robots answer at once, so that somebody can measure the way to them.
namespace rondo::deploy {

/// Names the topics on which a robot is asked, and answers.
struct EchoTopics {
  std::string questions, answers;
};
EchoTopics EchoTopicsOf(const sim::Fleet& fleet, size_t robot);
const ros::Message& EchoMessage();
inline constexpr ros::Qos kEchoes{.reliable = false, .depth = 64};

/// Is a question with its number and when it was asked; answered, also what the clock on the robot's wall said. Times are
/// nanoseconds since 1970.
struct Echo {
  uint32_t number = 0;
  int64_t asked = 0;
  int64_t answered = 0;  ///< 0: it is a question
};

/// Returns the message; reads one: nothing if it is none.
std::string Encoded(const Echo& echo);
std::optional<Echo> Decoded(std::string_view bytes);
/// Returns the answer to a question, with what the clock says now; nothing if it is none.
std::optional<std::string> AnswerTo(std::string_view question);

}  // namespace rondo::deploy
