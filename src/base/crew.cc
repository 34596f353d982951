#include "base/crew.h"

#include <algorithm>

namespace rondo::base {

Crew::Crew(unsigned size) {
  if (size == 0) size = std::max(1u, std::thread::hardware_concurrency());
  for (size_t member = 1; member < size; ++member) threads_.emplace_back([this, member] { Serve(member); });
}

Crew::~Crew() {
  {
    const std::scoped_lock lock(mutex_);
    over_ = true;
  }
  begin_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Crew::Work(size_t member) {
  std::unique_lock lock(mutex_);
  while (next_ < count_) {
    const size_t item = next_++;
    lock.unlock();
    (*work_)(member, item);
    lock.lock();
  }
}

void Crew::Serve(size_t member) {
  uint64_t seen = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      begin_.wait(lock, [&] { return over_ || round_ != seen; });
      if (over_) return;
      seen = round_;
    }
    Work(member);
    const std::scoped_lock lock(mutex_);
    if (--busy_ == 0) end_.notify_one();
  }
}

void Crew::Run(size_t count, const std::function<void(size_t, size_t)>& work) {
  if (threads_.empty() || count <= 1) {
    for (size_t i = 0; i < count; ++i) work(0, i);
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    work_ = &work;
    next_ = 0;
    count_ = count;
    busy_ = threads_.size();
    ++round_;
  }
  begin_.notify_all();
  Work(0);
  std::unique_lock lock(mutex_);
  end_.wait(lock, [&] { return busy_ == 0; });
}

}  // namespace rondo::base
