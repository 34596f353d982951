#include "base/stop.h"

#include <algorithm>

namespace rondo::base {

StopToken StopToken::WithDeadline(Clock::time_point deadline) const {
  StopToken result = *this;
  result.deadline_ = std::min(deadline_, deadline);
  return result;
}

}  // namespace rondo::base
