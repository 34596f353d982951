#pragma once

#include "base/stop.h"

namespace rondo::driver {

/// While it lives, Ctrl-C requests a stop through the token; a second Ctrl-C ends the process at once. One at
/// a time.
class InterruptScope {
 public:
  explicit InterruptScope(const base::StopToken& stop);
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  ~InterruptScope();
};

}  // namespace rondo::driver
