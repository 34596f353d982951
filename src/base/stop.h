#pragma once

#include <atomic>
#include <chrono>
#include <memory>

namespace rondo::base {

/// Asks long work to end: by hand (Ctrl-C) or at a deadline. Copies share the flag. Polled, never blocking.
class StopToken {
 public:
  using Clock = std::chrono::steady_clock;

  StopToken() : flag_(std::make_shared<std::atomic<bool>>(false)) {}

  /// The same flag with a deadline of its own: the earlier one of both.
  StopToken WithDeadline(Clock::time_point deadline) const;

  void RequestStop() const { flag_->store(true, std::memory_order_relaxed); }
  bool cancelled() const { return flag_->load(std::memory_order_relaxed); }
  bool expired() const { return deadline_ <= Clock::now(); }
  bool StopRequested() const { return cancelled() || expired(); }
  Clock::time_point deadline() const { return deadline_; }

 private:
  std::shared_ptr<std::atomic<bool>> flag_;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace rondo::base
