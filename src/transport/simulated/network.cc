#include "transport/simulated/network.h"

namespace rondo::transport::simulated {

Network::Network(size_t robots, uint64_t seed) : robots_(robots), random_(seed), cuts_(robots * robots) {}

void Network::Cut(uint32_t from, uint32_t to) { ++cuts_[from * robots_ + to]; }
void Network::Mend(uint32_t from, uint32_t to) {
  uint32_t& cuts = cuts_[from * robots_ + to];
  if (cuts > 0) --cuts;
}

double Network::Share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

void Network::Send(Time now, uint32_t from, uint32_t to, std::span<const uint8_t> bytes,
                   std::vector<Delivery>& out) {
  ++sent_;
  bytes_ += bytes.size();
  if (cuts_[from * robots_ + to] > 0 || Share() < conditions.loss) return;
  const int copies = Share() < conditions.duplicate ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    Delivery delivery{now, from, to, {bytes.begin(), bytes.end()}};
    const auto range = static_cast<uint64_t>(conditions.most - conditions.least) + 1;
    delivery.at += conditions.least + static_cast<Time>(random_() % range);
    if (Share() < conditions.corrupt && !bytes.empty()) {
      const uint64_t bit = random_() % (8 * bytes.size());
      delivery.bytes[bit / 8] ^= static_cast<uint8_t>(1U << (bit % 8));
    }
    out.push_back(std::move(delivery));
  }
}

}  // namespace rondo::transport::simulated
