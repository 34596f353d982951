#include "transport/dds/way.h"

#include <fmt/format.h>

#include <thread>

#include "ros/rondo_msgs.h"
#include "transport/mailbox.h"

namespace rondo::transport::dds {

using rondo::dds::Participant;
using rondo::dds::Publisher;
using rondo::dds::Subscription;
using runtime::codec::Bytes;
using runtime::codec::View;
using runtime::rounds::kAll;
using runtime::rounds::Time;

namespace {

using ros::rondo_msgs::Datagram;

constexpr ros::Qos kFrames{.reliable = false, .depth = 256};
constexpr size_t kMostBytes = 64'000;  // of a datagram
constexpr size_t kHeader = 12;         // the encoding, `to`, and how many bytes there are

class Way : public Transport {
 public:
  Way(Participant& participant, size_t node, const Fleet& fleet)
      : participant_(participant), node_(node), fleet_(fleet), to_one_(fleet.robots.size()) {}
  Way(const Way&) = delete;
  Way& operator=(const Way&) = delete;
  ~Way() override {
    outgoing_.Close();
    if (sender_.joinable()) sender_.join();
  }

  base::Result<bool> Begin() {
    auto all = participant_.Publish(node_, Topic("all"), Datagram::kMessage, kFrames);
    if (!all.ok()) return all.error();
    to_all_ = std::move(all).value();
    for (const std::string& mine : {std::string("all"), fleet_.robots[fleet_.self]}) {
      auto from = participant_.Subscribe(
          node_, Topic(mine), Datagram::kMessage, kFrames,
          [this](std::string_view bytes, const rondo::dds::Received&) { Arrives(bytes); },
          rondo::dds::From::kOthers);
      if (!from.ok()) return from.error();
      from_.push_back(std::move(from).value());
    }
    sender_ = std::thread([this] { Sends(); });
    return true;
  }

  Time Now() override { return BootTime(); }
  void Send(uint32_t to, View bytes) override { outgoing_.Put(to, bytes); }
  bool Receive(Time until, Bytes& datagram) override {
    std::swap(datagram, letter_.bytes);
    const bool came = incoming_.Take(until, letter_);
    std::swap(datagram, letter_.bytes);
    return came;
  }

 private:
  std::string Topic(const std::string& whom) const { return fmt::format("/rondo/{}/{}", fleet_.name, whom); }

  void Arrives(std::string_view bytes) {
    // As `Datagram`, without a copy more than needed.
    ros::CdrReader reader(bytes);
    uint32_t to = 0;
    reader.Value(to);
    const size_t count = reader.Count(1);
    if (!reader.ok() || count > kMostBytes || (to != kAll && to != fleet_.self)) return;
    incoming_.Put(fleet_.self, View(reinterpret_cast<const uint8_t*>(bytes.data()) + kHeader, count));
  }

  void Sends() {
    Mailbox::Letter letter;
    Datagram message;
    for (;;) {
      if (!outgoing_.Take(BootTime() + 1'000'000'000, letter)) {
        if (outgoing_.closed()) return;
        continue;
      }
      message.to = letter.to;
      message.bytes.assign(letter.bytes.begin(), letter.bytes.end());
      // What cannot be sent is lost, like anything on the way.
      if (Publisher* publisher = To(letter.to)) (void)publisher->Publish(message).ok();
    }
  }

  // Few robots tell each other something alone: a writer comes with the first word to a robot. Until they are connected,
  // all hear it, and the others drop it.
  Publisher* To(uint32_t robot) {
    if (robot == kAll) return to_all_.get();
    if (robot >= to_one_.size()) return nullptr;
    auto& one = to_one_[robot];
    if (one == nullptr) {
      auto made = participant_.Publish(node_, Topic(fleet_.robots[robot]), Datagram::kMessage, kFrames);
      if (made.ok()) one = std::move(made).value();
    }
    return one == nullptr || one->matched() == 0 ? to_all_.get() : one.get();
  }

  Participant& participant_;
  size_t node_;
  Fleet fleet_;
  Mailbox incoming_{1024}, outgoing_{1024};
  Mailbox::Letter letter_;
  std::unique_ptr<Publisher> to_all_;
  std::vector<std::unique_ptr<Publisher>> to_one_;  // only the sender's
  std::vector<std::unique_ptr<Subscription>> from_;
  std::thread sender_;
};

}  // namespace

base::Result<std::unique_ptr<Transport>> Connect(Participant& participant, size_t node, const Fleet& fleet) {
  auto way = std::make_unique<Way>(participant, node, fleet);
  const auto begun = way->Begin();
  if (!begun.ok()) return begun.error();
  return std::unique_ptr<Transport>(std::move(way));
}

}  // namespace rondo::transport::dds
