#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace rondo::base {

/// Hands items from some threads to another one: newest win, and nobody waits but who takes. Keeps the memory of items: after
/// a while nothing is allocated. The lock is held for as long as it takes to fill an item. Thread-safe.
template <class T>
class Ring {
 public:
  /// @param longest  how many items wait at most; the oldest give way.
  explicit Ring(size_t longest) : items_(longest) {}

  /// Adds an item, which `fill` writes over an old one.
  template <class Fill>
  void Put(const Fill& fill) {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_ == items_.size()) {
        first_ = (first_ + 1) % items_.size();
        --waiting_;
        ++lost_;
      }
      fill(items_[(first_ + waiting_++) % items_.size()]);
    }
    arrived_.notify_one();
  }
  /// Waits for so long, at most, and exchanges the oldest item for `item`, whose memory it keeps. Returns false, with
  /// `item` as it was, if there was none, or none is left after `Close`.
  bool Take(std::chrono::nanoseconds wait, T& item) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, wait, [&] { return waiting_ > 0 || closed_; }) || waiting_ == 0)
      return false;
    std::swap(item, items_[first_]);
    first_ = (first_ + 1) % items_.size();
    --waiting_;
    return true;
  }
  /// Ends all waiting, for ever; what waits can still be taken.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    arrived_.notify_all();
  }
  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }
  /// Returns how many items gave way before anybody took them.
  size_t lost() const {
    const std::lock_guard lock(mutex_);
    return lost_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<T> items_;
  size_t first_ = 0, waiting_ = 0, lost_ = 0;
  bool closed_ = false;
};

}  // namespace rondo::base
