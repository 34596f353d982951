#pragma once

#include "base/stop.h"
#include "runtime/sessions/member.h"
#include "transport/transport.h"

namespace rondo::transport {

/// Runs a robot's part of a session until it has an outcome: gives it datagrams and time, and sends what it says. Calls `stepped`
/// before each step, at least every 50 ms. When somebody asks for a stop it leaves, and tells the others.
/// When it returns, the others were told of the outcome, several times.
void Drive(runtime::sessions::Member& member, Transport& transport, const base::StopToken& stop,
           const std::function<void(runtime::sessions::Time)>& stepped);

}  // namespace rondo::transport
