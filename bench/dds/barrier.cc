// A barrier as one would write it by hand over Cyclone DDS, to measure rounds against: each process writes what it does, waits
// for all; writes that it has all, waits for all. One thread waits and writes. What is lost is written again after a
// millisecond.
//
//   barrier ROBOTS SELF ROUNDS PERIOD_US BYTES LOST     prints the microseconds of each round; LOST: packets of a thousand

#include <dds/dds.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "dds/network.h"
#include "dds/raw_type.h"

namespace {

using rondo::dds::CreateRawTopic;
using rondo::dds::TakeRaw;

int64_t Now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

struct Word {
  uint32_t encoding = 0x0100;  // CDR, little endian
  uint32_t robot = 0, round = 0, phase = 0;
};

class Barrier {
 public:
  Barrier(uint32_t robots, uint32_t self, size_t bytes, uint32_t lost)
      : self_(self), seen_(robots), text_(sizeof(Word) + bytes, 'x') {
    const std::string configuration = rondo::dds::Configuration({.lost_in_thousand = lost});
    const auto domain = static_cast<dds_domainid_t>(std::atoi(std::getenv("ROS_DOMAIN_ID")));
    dds_create_domain(domain, configuration.c_str());
    const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
    const dds_entity_t topic = CreateRawTopic(participant, "barrier", "Barrier", nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 256);
    dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
    reader_ = dds_create_reader(participant, topic, qos, nullptr);
    writer_ = dds_create_writer(participant, topic, qos, nullptr);
    dds_delete_qos(qos);
    waitset_ = dds_create_waitset(participant);
    dds_waitset_attach(waitset_, dds_create_readcondition(reader_, DDS_ANY_STATE), 0);
    dds_publication_matched_status_t status{};
    do {
      const timespec nap{0, 10'000'000};
      ::nanosleep(&nap, nullptr);
      dds_get_publication_matched_status(writer_, &status);
    } while (status.current_count + 1 < robots);
  }

  // Returns when all others are there.
  void Pass(uint32_t round, uint32_t phase) {
    const uint64_t mine = 2 * uint64_t{round} + phase + 1;
    seen_[self_] = mine;
    Write(round, phase);
    while (!All(mine)) {
      dds_attach_t what;
      if (dds_waitset_wait(waitset_, &what, 1, DDS_MSECS(1)) == 0) Write(round, phase);
      Take(round, phase);
    }
  }

 private:
  void Write(uint32_t round, uint32_t phase) {
    const Word word{0x0100, self_, round, phase};
    std::memcpy(text_.data(), &word, sizeof(word));
    const std::string_view view = text_;
    dds_write(writer_, &view);
  }
  void Take(uint32_t, uint32_t) {
    dds_sample_info_t info;
    while (TakeRaw(reader_, bytes_, info)) {
      if (!info.valid_data || bytes_.size() < sizeof(Word)) continue;
      Word word;
      std::memcpy(&word, bytes_.data(), sizeof(word));
      uint64_t& seen = seen_[word.robot];
      const uint64_t at = 2 * uint64_t{word.round} + word.phase + 1;
      seen = at > seen ? at : seen;
    }
  }
  bool All(uint64_t at) const {
    for (const uint64_t seen : seen_) {
      if (seen < at) return false;
    }
    return true;
  }

  uint32_t self_;
  std::vector<uint64_t> seen_;
  std::string text_, bytes_;
  dds_entity_t reader_ = 0, writer_ = 0, waitset_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) return 2;
  const auto robots = static_cast<uint32_t>(std::atoi(argv[1])),
             self = static_cast<uint32_t>(std::atoi(argv[2]));
  const auto rounds = static_cast<uint32_t>(std::atoi(argv[3]));
  const int64_t period = std::atoll(argv[4]) * 1000;
  Barrier barrier(robots, self, static_cast<size_t>(std::atoi(argv[5])),
                  static_cast<uint32_t>(std::atoi(argv[6])));
  int64_t next = 0;
  for (uint32_t round = 0; round < rounds; ++round) {
    if (const int64_t left = next - Now(); left > 0) {
      const timespec nap{0, left};
      ::nanosleep(&nap, nullptr);
    }
    const int64_t begin = Now();
    barrier.Pass(round, 0);
    barrier.Pass(round, 1);
    const int64_t end = Now();
    std::printf("%lld\n", static_cast<long long>((end - begin) / 1000));
    // From the end: what one is late the others are, too.
    next = end + period;
  }
  // Others may still lack the last word.
  for (int i = 0; i < 100; ++i) {
    const timespec nap{0, 5'000'000};
    ::nanosleep(&nap, nullptr);
  }
  return 0;
}
