#include "transport/loopback/loopback.h"

#include <chrono>
#include <ctime>

namespace rondo::transport::loopback {

using runtime::codec::Bytes;
using runtime::codec::View;
using runtime::rounds::Time;

class Hub::Way : public Transport {
 public:
  Way(Hub& hub, uint32_t robot) : hub_(hub), robot_(robot) {}

  Time Now() override {
    timespec now{};
    ::clock_gettime(CLOCK_BOOTTIME, &now);
    return static_cast<Time>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
  }

  void Send(uint32_t to, View bytes) override {
    for (uint32_t r = 0; r < hub_.mailboxes_.size(); ++r) {
      if (r == robot_ || (to != runtime::rounds::kAll && to != r)) continue;
      Mailbox& box = *hub_.mailboxes_[r];
      {
        const std::lock_guard lock(box.mutex);
        const size_t longest = box.ring.size();
        if (box.waiting == longest) {
          box.first = (box.first + 1) % longest;
          --box.waiting;
        }
        box.ring[(box.first + box.waiting++) % longest].assign(bytes.begin(), bytes.end());
      }
      box.arrived.notify_one();
    }
  }

  bool Receive(Time until, Bytes& datagram) override {
    datagram.clear();
    Mailbox& box = *hub_.mailboxes_[robot_];
    std::unique_lock lock(box.mutex);
    const std::chrono::nanoseconds left(std::max<Time>(0, until - Now()));
    if (!box.arrived.wait_for(lock, left, [&] { return box.waiting > 0; })) return false;
    std::swap(datagram, box.ring[box.first]);
    box.first = (box.first + 1) % box.ring.size();
    --box.waiting;
    return true;
  }

 private:
  Hub& hub_;
  uint32_t robot_;
};

Hub::Hub(size_t robots, size_t longest) {
  for (size_t r = 0; r < robots; ++r) {
    mailboxes_.push_back(std::make_unique<Mailbox>());
    mailboxes_.back()->ring.resize(longest);
  }
}

std::unique_ptr<Transport> Hub::Connect(uint32_t robot) { return std::make_unique<Way>(*this, robot); }

}  // namespace rondo::transport::loopback
