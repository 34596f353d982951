#pragma once

#include <variant>

#include "runtime/codec/messages.h"
#include "runtime/sessions/session.h"

/// The datagrams of sessions (docs/runtime.md, "Sessions on the wire").
namespace rondo::runtime::sessions {

/// Says how far a robot is with its session.
enum class Phase : uint8_t {
  kGathering,  ///< it waits until all have heard of all
  kRunning,
  kEnded,     ///< its program is at its end, unless a message comes
  kFinished,  ///< so are those of all others, and no message is on its way
  kStopped,   ///< somebody wants the session to end, and asked this robot or another one to stop
  kGone,      ///< it takes no part any more: it cannot go on
};
/// Returns `gathering`, `running`, `ended`, `finished`, `stopped` or `gone`.
std::string_view Name(Phase phase);

/// Says that a robot is there, and how far it is: to all, again and again.
struct Alive {
  Phase phase = Phase::kGathering;
  codec::MemberSet heard;  ///< of whom it has heard
  /// By robot, in all phases from kEnded on: how many messages it sent to it, and took from it. If these agree among robots that
  /// all are at their ends, no message is on its way and none will ever be.
  std::vector<uint64_t> sent, taken;
  friend bool operator==(const Alive&, const Alive&) = default;
};

/// Holds one datagram.
struct Datagram {
  uint64_t agreement =
      0;  ///< sum of what all robots must have in common: the choreography, who follows what, the version
  codec::Member sender;
  std::variant<Alive, Frame> body;  ///< a frame is of the sender and has its session
};

constexpr size_t kMostLabel = 256;   ///< bytes
constexpr size_t kMostValues = 256;  ///< that one message carries

/// Appends a datagram of a session to `out`, with a sum in front.
void Encode(const Datagram& datagram, uint64_t session, codec::Bytes& out);

/// Reads a datagram. `agreement` and `session` have to be these.
/// @param robots  how many there are; no datagram mentions others.
codec::Refused Decode(codec::View bytes, uint64_t agreement, uint64_t session, size_t robots,
                      Datagram& datagram);

}  // namespace rondo::runtime::sessions
