// The radio in virtual time keeps what every transport keeps, as far as it is told to lose nothing.
#include <algorithm>

#include "transport/conformance_test.h"
#include "transport/simulated/network.h"

namespace rondo::transport {
namespace simulated {
namespace {

// One thread, and one clock that goes on when somebody waits.
class Radio {
 public:
  std::vector<std::unique_ptr<Transport>> Connect(size_t robots) {
    network_ = std::make_unique<Network>(robots, 1);
    std::vector<std::unique_ptr<Transport>> ways;
    for (uint32_t r = 0; r < robots; ++r) ways.push_back(std::make_unique<Way>(*this, r, robots));
    return ways;
  }

 private:
  class Way : public Transport {
   public:
    Way(Radio& radio, uint32_t robot, size_t robots) : radio_(radio), robot_(robot), robots_(robots) {}
    runtime::rounds::Time Now() override { return radio_.now_; }
    void Send(uint32_t to, runtime::codec::View bytes) override {
      for (uint32_t r = 0; r < robots_; ++r) {
        if (r != robot_ && (to == kAll || to == r))
          radio_.network_->Send(radio_.now_, robot_, r, bytes, radio_.flying_);
      }
    }
    bool Receive(runtime::rounds::Time until, Bytes& datagram) override {
      datagram.clear();
      auto first = radio_.flying_.end();
      for (auto it = radio_.flying_.begin(); it != radio_.flying_.end(); ++it) {
        if (it->to == robot_ && (first == radio_.flying_.end() || it->at < first->at)) first = it;
      }
      const bool comes = first != radio_.flying_.end() && first->at <= std::max(until, radio_.now_);
      radio_.now_ = std::max(radio_.now_, comes ? first->at : until);
      if (!comes) return false;
      datagram = std::move(first->bytes);
      radio_.flying_.erase(first);
      return true;
    }

   private:
    Radio& radio_;
    uint32_t robot_;
    size_t robots_;
  };

  std::unique_ptr<Network> network_;
  std::vector<Delivery> flying_;
  runtime::rounds::Time now_ = 0;
};

}  // namespace
}  // namespace simulated

INSTANTIATE_TYPED_TEST_SUITE_P(Radio, TransportConformance, simulated::Radio);

}  // namespace rondo::transport
