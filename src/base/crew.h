#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace rondo::base {

/// Holds threads for work that comes in many short pieces: `ParallelFor` would start them anew each time.
class Crew {
 public:
  /// Starts `size - 1` threads (0: as many as the machine has cores); the caller of `Run` is the remaining one.
  explicit Crew(unsigned size);
  /// Ends the threads.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  size_t size() const { return threads_.size() + 1; }
  /// Runs `work(member, i)` for each i in [0, count) and returns when all have ended. Members are numbered from 0, the
  /// caller's number; each runs one item at a time, and takes the next in order. `work` must not throw.
  void Run(size_t count, const std::function<void(size_t member, size_t item)>& work);

 private:
  void Serve(size_t member);
  void Work(size_t member);

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  const std::function<void(size_t, size_t)>* work_ = nullptr;
  size_t next_ = 0, count_ = 0;
  size_t busy_ = 0;     // threads that have not ended the work at hand
  uint64_t round_ = 0;  // how often there was work
  bool over_ = false;
};

}  // namespace rondo::base
