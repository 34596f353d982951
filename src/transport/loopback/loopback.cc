#include "transport/loopback/loopback.h"

namespace rondo::transport::loopback {

using runtime::codec::Bytes;
using runtime::codec::View;
using runtime::rounds::Time;

class Hub::Way : public Transport {
 public:
  Way(Hub& hub, uint32_t robot) : hub_(hub), robot_(robot) {}

  Time Now() override { return BootTime(); }

  void Send(uint32_t to, View bytes) override {
    for (uint32_t r = 0; r < hub_.mailboxes_.size(); ++r) {
      if (r != robot_ && (to == runtime::rounds::kAll || to == r)) hub_.mailboxes_[r]->Put(r, bytes);
    }
  }

  bool Receive(Time until, Bytes& datagram) override {
    std::swap(datagram, letter_.bytes);
    const bool came = hub_.mailboxes_[robot_]->Take(until, letter_);
    std::swap(datagram, letter_.bytes);
    return came;
  }

 private:
  Hub& hub_;
  uint32_t robot_;
  Mailbox::Letter letter_;
};

Hub::Hub(size_t robots, size_t longest) {
  for (size_t r = 0; r < robots; ++r) mailboxes_.push_back(std::make_unique<Mailbox>(longest));
}

std::unique_ptr<Transport> Hub::Connect(uint32_t robot) { return std::make_unique<Way>(*this, robot); }

}  // namespace rondo::transport::loopback
