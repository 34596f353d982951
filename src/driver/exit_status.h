#pragma once

namespace rondo::driver {

enum ExitStatus : int { kEstablished = 0, kRejected = 1, kUsage = 2, kUndecided = 3, kBug = 4 };

}  // namespace rondo::driver
