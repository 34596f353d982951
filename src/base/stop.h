#pragma once

#include <atomic>
#include <chrono>
#include <memory>

/// How long work is asked to end. Work polls its token; nothing is ever interrupted from outside.
namespace rondo::base {

/// Asks long work to end: by hand (Ctrl-C) or at a deadline. Copies share the flag, but each has its own
/// deadline. Polled, never blocking; the flag may be set from a signal handler or another thread.
class StopToken {
 public:
  using Clock = std::chrono::steady_clock;

  StopToken() : flag_(std::make_shared<std::atomic<bool>>(false)) {}

  /// Returns a token with the same flag and a deadline of its own: the earlier one of both.
  StopToken WithDeadline(Clock::time_point deadline) const;

  void RequestStop() const { flag_->store(true, std::memory_order_relaxed); }
  /// Reports whether somebody asked for the end by hand.
  bool cancelled() const { return flag_->load(std::memory_order_relaxed); }
  /// Reports whether the deadline has passed. Costs a look at the clock.
  bool expired() const { return deadline_ <= Clock::now(); }
  bool StopRequested() const { return cancelled() || expired(); }
  Clock::time_point deadline() const { return deadline_; }

 private:
  std::shared_ptr<std::atomic<bool>> flag_;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace rondo::base
