#include "transport/transport.h"

#include <algorithm>

namespace rondo::transport {

using runtime::codec::View;
using runtime::rounds::Output;
using runtime::rounds::Time;

void Drive(runtime::rounds::Core& core, Transport& transport, const base::StopToken& stop,
           const std::function<void(Time, const Output&)>& observe,
           const std::function<void(Time)>& stepped) {
  constexpr Time kLook = 50'000'000;
  runtime::rounds::Outputs outputs;
  runtime::codec::Bytes datagram;
  while (!stop.StopRequested()) {
    const Time now = transport.Now();
    outputs.Clear();
    core.Step(now, View(datagram), outputs);
    for (const Output& output : outputs) {
      if (const auto* send = std::get_if<runtime::rounds::Send>(&output))
        transport.Send(send->to, send->bytes);
      else
        observe(now, output);
    }
    if (stepped) stepped(now);
    transport.Receive(std::min(core.wake(), now + kLook), datagram);
  }
}

}  // namespace rondo::transport
