// Any datagrams: a robot of a choreography takes them, and its session has an end at some time. Each datagram gets what it needs to be
// looked at: sum, version, agreement, session.
#include <algorithm>
#include <cstdint>

#include "runtime/sessions/talker_test.h"

using namespace rondo::runtime;
using codec::Bytes;
using codec::View;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  View input(data, size);
  sessions::Talker talker;
  talker.robots = 3;
  for (int i = 0; i < 4; ++i) talker.to_send.push_back({1, 100.0 * i});
  sessions::MemberSettings settings;
  settings.robots = talker.robots;
  sessions::Member member(settings, talker, talker);
  // What stands in front of what a datagram says: magic number, version, agreement, session.
  Bytes head;
  sessions::Encode({0, {1, 1}, sessions::Alive()}, 0, head);
  head.resize(8 + 2 + 16);
  sessions::Time now = 0;
  while (!input.empty()) {
    const size_t count = std::min<size_t>(input[0], input.size() - 1);
    Bytes datagram = head;
    const View body = input.subspan(1, count);
    datagram.insert(datagram.end(), body.begin(), body.end());
    input = input.subspan(1 + count);
    Bytes sum;
    codec::Writer(sum).Fixed(codec::Sum(View(datagram).subspan(8)));
    std::ranges::copy(sum, datagram.begin());
    now += 1'000'000 * (1 + static_cast<int64_t>(count % 50));
    member.Step(now, datagram);
  }
  // Nobody answers any more.
  if (member.phase() == sessions::Phase::kGathering) return 0;
  for (int i = 0; i < 100; ++i) member.Step(now += settings.patience / 10, {});
  return member.outcome() == sessions::Outcome::kOpen ? (__builtin_trap(), 1) : 0;
}
