// How long a synchronous message takes from its offer until its sender knows that it was taken, over DDS on this machine; and beside it a
// ping and its answer as one would write them by hand over Cyclone DDS: one thread, what is lost is written again after RESEND_US.
//
//   messages rondo|hand SELF COUNT RESEND_US LOST     SELF: 0 sends, 1 answers; 0 prints the microseconds of each. LOST: packets of a thousand

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "dds/participant.h"
#include "ends.h"
#include "transport/dds/way.h"
#include "transport/mailbox.h"
#include "transport/sessions.h"

namespace {

using rondo::runtime::sessions::Step;
using rondo::transport::BootTime;

struct Arguments {
  uint32_t self = 0;
  int count = 0;
  int64_t resend = 0;  // nanoseconds
  uint32_t lost = 0;
  std::vector<double> took{};  // microseconds
};

rondo::dds::Network NetworkOf(const Arguments& a) {
  rondo::dds::Network network;
  network.domain = static_cast<uint32_t>(std::atoi(std::getenv("ROS_DOMAIN_ID")));
  network.lost_in_thousand = a.lost;
  return network;
}

/// Sends or takes so many messages.
class Talk : public rondo::runtime::sessions::Program, public rondo::runtime::sessions::Motions {
 public:
  explicit Talk(Arguments& a) : a_(a) {}
  Step Next() override {
    Step step;
    if (done_ == a_.count) return step;
    step.kind = a_.self == 0 ? Step::Kind::kSend : Step::Kind::kReceive;
    step.to = 1;
    step.label = "message";
    step.values = {1, 2, 3};
    if (a_.self == 1) step.cases = {{0, "message"}};
    begun_ = BootTime();
    return step;
  }
  bool Waits() const override { return false; }
  void Sent() override {
    a_.took.push_back(static_cast<double>(BootTime() - begun_) * 1e-3);
    ++done_;
  }
  void Took(size_t /*which*/, const std::vector<double>& /*values*/) override { ++done_; }
  void Moved() override {}
  void Begin(size_t /*motion*/) override {}
  rondo::runtime::sessions::Progress Tick() override { return rondo::runtime::sessions::Progress::kStopped; }
  void Halt() override {}

 private:
  Arguments& a_;
  int done_ = 0;
  int64_t begun_ = 0;
};

int Rondo(Arguments& a) {
  auto participant = rondo::dds::Participant::Open(NetworkOf(a));
  if (!participant.ok()) return 1;
  const size_t node = participant.value()->AddNode({"/", "messages"});
  auto way = rondo::transport::dds::Connect(*participant.value(), node, {"messages", {"a", "b"}, a.self});
  if (!way.ok()) return 1;
  Talk talk(a);
  rondo::runtime::sessions::MemberSettings settings;
  settings.self = a.self;
  settings.robots = 2;
  settings.resend = a.resend;
  settings.patience = 10'000'000'000;
  rondo::runtime::sessions::Member member(settings, talk, talk);
  rondo::transport::Drive(member, *way.value(), rondo::base::StopToken(), [](int64_t) {});
  return member.outcome() == rondo::runtime::sessions::Outcome::kOver ? 0 : 1;
}

/// Writes a number until the other one says it, too.
class Hand {
 public:
  explicit Hand(const Arguments& a) : a_(a), ends_(NetworkOf(a), "ping", 1) {}

  void Ping(uint32_t number) {
    Write(number);
    while (seen_ < number) {
      if (!Wait(a_.resend)) Write(number);
      Take(false);
    }
  }
  void Answer(uint32_t last) {
    while (seen_ < last) {
      Wait(a_.resend);
      Take(true);
    }
    // The last answer may get lost.
    for (const int64_t end = BootTime() + 1'000'000'000; BootTime() < end; Take(true)) Wait(a_.resend);
  }

 private:
  bool Wait(int64_t most) {
    dds_attach_t what;
    return dds_waitset_wait(ends_.waitset, &what, 1, most) > 0;
  }
  void Write(uint32_t number) {
    text_.assign(40, 'x');
    const uint32_t encoding = 0x0100;  // CDR, little endian
    std::memcpy(text_.data(), &encoding, 4);
    std::memcpy(text_.data() + 4, &number, 4);
    const std::string_view view = text_;
    dds_write(ends_.writer, &view);
  }
  void Take(bool answers) {
    dds_sample_info_t info;
    while (rondo::dds::TakeRaw(ends_.reader, bytes_, info)) {
      if (!info.valid_data || bytes_.size() < 8) continue;
      uint32_t number = 0;
      std::memcpy(&number, bytes_.data() + 4, 4);
      seen_ = number > seen_ ? number : seen_;
      if (answers) Write(number);
    }
  }

  const Arguments& a_;
  std::string text_, bytes_;
  uint32_t seen_ = 0;
  bench::Ends ends_;
};

int ByHand(Arguments& a) {
  Hand hand(a);
  if (a.self == 1) {
    hand.Answer(static_cast<uint32_t>(a.count));
    return 0;
  }
  for (int i = 1; i <= a.count; ++i) {
    const int64_t begun = BootTime();
    hand.Ping(static_cast<uint32_t>(i));
    a.took.push_back(static_cast<double>(BootTime() - begun) * 1e-3);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  Arguments a{static_cast<uint32_t>(std::atoi(argv[2])), std::atoi(argv[3]), std::atoll(argv[4]) * 1000,
              static_cast<uint32_t>(std::atoi(argv[5]))};
  const int status = std::string_view(argv[1]) == "rondo" ? Rondo(a) : ByHand(a);
  for (const double t : a.took) std::printf("%.1f\n", t);
  return status;
}
