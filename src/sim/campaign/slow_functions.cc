#include "sim/campaign/slow_functions.h"

namespace rondo::sim::campaign {

using koord::semantics::Answer;
using koord::semantics::Word;

Answer SlowFunctions::Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) {
  if (node_.round() > 0) {
    const auto [it, fresh] = ready_.try_emplace(any_.Number(f, robot, arguments), now_ + delay_);
    if (now_ < it->second) return Answer::kLater;
  }
  return any_.Call(f, robot, arguments, result);
}

}  // namespace rondo::sim::campaign
