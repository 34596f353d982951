#pragma once

#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

#include "dds/network.h"

namespace rondo::dds {

/// Returns a network of this machine that other tests are not in.
inline Network TestNetwork() { return {.domain = 10 + static_cast<uint32_t>(::getpid()) % 80}; }

/// Waits until something is so, ten seconds at most; returns whether it is.
inline bool Eventually(const std::function<bool()>& so) {
  for (int i = 0; i < 1000; ++i) {
    if (so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return so();
}

}  // namespace rondo::dds
