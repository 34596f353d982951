#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "transport/simulated/network.h"

/// What goes wrong on networks and with robots, in virtual time.
namespace rondo::sim::cores {

using transport::simulated::Time;

/// Converts seconds, as files and people have them, to the nearest time; and back.
inline Time Nanoseconds(double seconds) { return static_cast<Time>(std::llround(seconds * 1e9)); }
inline double Seconds(Time time) { return static_cast<double>(time) * 1e-9; }

/// Names what goes wrong for a while.
enum class FaultKind : uint8_t {
  kLoss,       ///< a share of all datagrams is lost
  kDelay,      ///< datagrams take up to so long, in seconds
  kDuplicate,  ///< a share of all datagrams comes twice
  kCorrupt,    ///< a share of all datagrams is damaged
  kOneWay,     ///< nothing comes from one robot to another
  kCut,        ///< two robots do not hear each other
  kAlone,      ///< nobody hears a robot, and it hears nobody
  kCrash,      ///< a robot is gone, and comes back with its disk, if it has one
  kForget,     ///< a robot is gone, and comes back without its disk
  kPause,      ///< a robot stands still, and goes on as if nothing had been
  kDiskFull,   ///< the disk of a robot takes nothing
  kSlow,       ///< a robot needs so long for each step, in seconds
  kPlanner,    ///< what a robot asks a function of a port for the first time takes so long, in seconds
  kClock,      ///< the clock on the wall of a robot is so far ahead, in seconds
};
constexpr size_t kFaultKinds = static_cast<size_t>(FaultKind::kClock) + 1;
std::string_view Name(FaultKind kind);

/// Is one thing that goes wrong, from a moment on, for a while.
struct Fault {
  FaultKind kind = FaultKind::kLoss;
  Time at = 0, length = 0;  ///< nanoseconds
  uint32_t robot = 0, other = 0;
  double amount = 0;  ///< a share, or seconds
};
/// Returns it in words: "from 0.52 s on, for 0.30 s: robots 0 and 2 do not hear each other".
std::string Tell(const Fault& fault);

}  // namespace rondo::sim::cores
