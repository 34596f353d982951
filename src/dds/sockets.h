#pragma once

#include <set>

namespace rondo::dds {

/// Returns the datagram sockets that this process has, by number.
std::set<int> DatagramSockets();

/// Lets sending on all such sockets but these wait for a millisecond at most. The library opens its sockets so that sending
/// waits for a network that stands still, and offers no way to say otherwise; what it cannot send, it drops.
void LimitSending(const std::set<int>& but);

}  // namespace rondo::dds
