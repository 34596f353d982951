// A barrier as one would write it by hand over Cyclone DDS, to measure rounds against: each process writes what it does, waits
// for all; writes that it has all, waits for all. One thread waits and writes. What is lost is written again after a
// millisecond.
//
//   barrier ROBOTS SELF ROUNDS PERIOD_US BYTES LOST     prints the microseconds of each round; LOST: packets of a thousand

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "ends.h"

namespace {

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

rondo::dds::Network NetworkOf(uint32_t lost) {
  rondo::dds::Network network;
  network.domain = static_cast<uint32_t>(std::atoi(std::getenv("ROS_DOMAIN_ID")));
  network.lost_in_thousand = lost;
  return network;
}

class Barrier {
 public:
  Barrier(uint32_t robots, uint32_t self, size_t bytes, uint32_t lost)
      : self_(self),
        seen_(robots),
        text_(sizeof(Word) + bytes, 'x'),
        ends_(NetworkOf(lost), "barrier", robots - 1) {}

  // Returns when all others are there.
  void Pass(uint32_t round, uint32_t phase) {
    const uint64_t mine = 2 * uint64_t{round} + phase + 1;
    seen_[self_] = mine;
    Write(round, phase);
    while (!All(mine)) {
      dds_attach_t what;
      if (dds_waitset_wait(ends_.waitset, &what, 1, DDS_MSECS(1)) == 0) Write(round, phase);
      Take(round, phase);
    }
  }

 private:
  void Write(uint32_t round, uint32_t phase) {
    const Word word{0x0100, self_, round, phase};
    std::memcpy(text_.data(), &word, sizeof(word));
    const std::string_view view = text_;
    dds_write(ends_.writer, &view);
  }
  void Take(uint32_t, uint32_t) {
    dds_sample_info_t info;
    while (TakeRaw(ends_.reader, bytes_, info)) {
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
  bench::Ends ends_;
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
