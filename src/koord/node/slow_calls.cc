#include "koord/node/slow_calls.h"

namespace rondo::koord::node {

using semantics::Answer;
using semantics::Layout;

uint64_t QuestionOf(const semantics::Team& team, size_t f, size_t robot, std::span<const Word> arguments) {
  const Function& function = team.model().functions[f];
  runtime::codec::Bytes bytes;
  runtime::codec::Writer writer(bytes);
  writer.Number(f);
  writer.Number(function.port < 0 ? 0 : robot);
  size_t at = 0;
  for (const lang::TypeId parameter : function.parameters) {
    const uint32_t width = Layout::Width(team.model().types, parameter);
    EncodeValue(team.model().types, team.heap(), parameter, arguments.subspan(at, width), writer);
    at += width;
  }
  return runtime::codec::Sum(bytes);
}

Answer SlowCalls::Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) {
  if (delay_ > 0 && node_.round() > 0 && team_.model().functions[f].port >= 0) {
    const auto [it, fresh] = ready_.try_emplace(QuestionOf(team_, f, robot, arguments), now_ + delay_);
    if (now_ < it->second) return Answer::kLater;
  }
  return host_.Call(f, robot, arguments, result);
}

}  // namespace rondo::koord::node
