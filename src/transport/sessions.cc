#include "transport/sessions.h"

#include <algorithm>

namespace rondo::transport {

using runtime::sessions::Member;
using runtime::sessions::Outcome;
using runtime::sessions::Time;

void Drive(Member& member, Transport& transport, const base::StopToken& stop,
           const std::function<void(Time)>& stepped) {
  constexpr Time kLook = 50'000'000;
  constexpr int kFarewells = 5;  // each may get lost
  runtime::codec::Bytes datagram;
  const auto step = [&] {
    const Time now = transport.Now();
    stepped(now);
    for (const Member::Letter& letter : member.Step(now, datagram))
      transport.Send(letter.to.value_or(runtime::rounds::kAll), letter.bytes);
    transport.Receive(std::min(member.wake(), now + kLook), datagram);
  };
  while (member.outcome() == Outcome::kOpen) {
    if (stop.StopRequested()) member.Leave();
    step();
  }
  if (member.outcome() == Outcome::kOver) return;
  const Time until = transport.Now() + kFarewells * kLook;
  while (transport.Now() < until) step();
}

}  // namespace rondo::transport
