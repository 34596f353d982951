#include "transport/dds/way.h"

#include <fmt/format.h>

#include <atomic>
#include <cstring>
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
constexpr size_t kHeader = 12;  // of a `Datagram` in CDR: the encoding, `to`, and how many bytes there are

class Way : public Transport {
 public:
  Way(Participant& participant, size_t node, const Fleet& fleet)
      : participant_(participant),
        node_(node),
        fleet_(fleet),
        to_one_(fleet.robots.size()),
        wanted_(fleet.robots.size()),
        asked_(fleet.robots.size()) {}
  Way(const Way&) = delete;
  Way& operator=(const Way&) = delete;
  ~Way() override {
    wanted_.Close();
    if (maker_.joinable()) maker_.join();
    for (const auto& one : to_one_) delete one.load();
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
    maker_ = std::thread([this] { Make(); });
    return true;
  }

  Time Now() override { return BootTime(); }

  // What cannot be sent is lost, like anything on the way.
  void Send(uint32_t to, View bytes) override {
    const auto count = static_cast<uint32_t>(bytes.size());
    std::memcpy(sent_.data() + 4, &to, 4);
    std::memcpy(sent_.data() + 8, &count, 4);
    sent_.resize(kHeader);
    sent_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    (void)To(to).Write(sent_).ok();
  }

  bool Receive(Time until, Bytes& datagram) override {
    std::swap(datagram, letter_.bytes);
    const bool came = incoming_.Take(until, letter_);
    std::swap(datagram, letter_.bytes);
    return came;
  }

 private:
  std::string Topic(const std::string& whom) const { return FramesTopic(fleet_.name, whom); }

  void Arrives(std::string_view bytes) {
    // As `Datagram`, without a copy more than needed.
    ros::CdrReader reader(bytes);
    uint32_t to = 0;
    reader.Value(to);
    const size_t count = reader.Count(1);
    if (!reader.ok() || count > kMostBytes || (to != kAll && to != fleet_.self)) return;
    incoming_.Put(fleet_.self, View(reinterpret_cast<const uint8_t*>(bytes.data()) + kHeader, count));
  }

  // Few robots tell each other something alone: a writer is made after the first word to a robot. Until they are connected,
  // all hear it, and the others drop it.
  Publisher& To(uint32_t robot) {
    if (robot == kAll || robot >= to_one_.size()) return *to_all_;
    Publisher* one = to_one_[robot].load(std::memory_order_acquire);
    if (one == nullptr && !asked_[robot]) {
      asked_[robot] = true;
      wanted_.Put([&](uint32_t& wanted) { wanted = robot; });
    }
    return one == nullptr || one->matched() == 0 ? *to_all_ : *one;
  }

  void Make() {
    uint32_t robot = 0;
    while (!wanted_.closed()) {
      if (!wanted_.Take(std::chrono::seconds(1), robot)) continue;
      auto made = participant_.Publish(node_, Topic(fleet_.robots[robot]), Datagram::kMessage, kFrames);
      if (made.ok()) to_one_[robot].store(std::move(made).value().release(), std::memory_order_release);
    }
  }

  Participant& participant_;
  size_t node_;
  Fleet fleet_;
  std::string sent_ =
      std::string("\x00\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00", kHeader);  // a `Datagram`
  Mailbox incoming_{1024};
  Mailbox::Letter letter_;
  std::unique_ptr<Publisher> to_all_;
  std::vector<std::atomic<Publisher*>> to_one_;  // made when somebody wants them
  base::Ring<uint32_t> wanted_;
  std::vector<bool> asked_;
  std::thread maker_;
  std::vector<std::unique_ptr<Subscription>> from_;  // last: nothing arrives any more when the others go
};

}  // namespace

std::string FramesTopic(const std::string& fleet, const std::string& whom) {
  return fmt::format("/rondo/{}/{}", fleet, whom);
}

base::Result<std::unique_ptr<Transport>> Connect(Participant& participant, size_t node, const Fleet& fleet) {
  auto way = std::make_unique<Way>(participant, node, fleet);
  const auto begun = way->Begin();
  if (!begun.ok()) return begun.error();
  return std::unique_ptr<Transport>(std::move(way));
}

}  // namespace rondo::transport::dds
