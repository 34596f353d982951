#include "transport/mailbox.h"

#include <algorithm>
#include <ctime>

namespace rondo::transport {

using runtime::rounds::Time;

Time BootTime() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<Time>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void Mailbox::Put(uint32_t to, runtime::codec::View bytes) {
  letters_.Put([&](Letter& letter) {
    letter.to = to;
    letter.bytes.assign(bytes.begin(), bytes.end());
  });
}

bool Mailbox::Take(Time until, Letter& letter) {
  letter.bytes.clear();
  return letters_.Take(std::chrono::nanoseconds(std::max<Time>(0, until - BootTime())), letter);
}

}  // namespace rondo::transport
