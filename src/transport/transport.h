#pragma once

#include <functional>

#include "base/stop.h"
#include "runtime/rounds/core.h"

/// How a core meets the world: one thread for each robot, and a way to the others.
namespace rondo::transport {

/// Carries the datagrams of one robot. They may be lost, doubled, late and overtaken; nothing blocks but
/// `Receive`. Only the robot's own thread uses it.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Returns what a clock says that never steps back and runs through suspension, in nanoseconds.
  virtual runtime::rounds::Time Now() = 0;
  /// Sends a datagram to a robot, or to `runtime::rounds::kAll` others.
  virtual void Send(uint32_t to, runtime::codec::View bytes) = 0;
  /// Waits for a datagram until this moment, at most, and puts it into `datagram`, whose memory it may take in exchange.
  /// Returns false, with `datagram` empty, if none came.
  virtual bool Receive(runtime::rounds::Time until, runtime::codec::Bytes& datagram) = 0;
};

/// Runs a core until somebody asks for a stop: gives it datagrams and time, sends what it says, and calls
/// `observe` with everything else that it wants or tells, in order, and `stepped` after each step. Looks for a stop at least
/// every 50 ms.
void Drive(runtime::rounds::Core& core, Transport& transport, const base::StopToken& stop,
           const std::function<void(runtime::rounds::Time, const runtime::rounds::Output&)>& observe,
           const std::function<void(runtime::rounds::Time)>& stepped = {});

}  // namespace rondo::transport
