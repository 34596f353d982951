#pragma once

#include <string_view>

#include "runtime/codec/bytes.h"

/// What the round protocol wants of a program: it knows nothing else of it.
namespace rondo::runtime::rounds {

using codec::Bytes;
using codec::View;

/// Is what a robot does in a round if it gets the lock that it wants; or an event without a lock.
struct Alternative {
  uint32_t event = 0;
  bool locks = false;  ///< at most one robot in a round does this event
  View effect;         ///< what the program writes, in its own encoding
};

/// Is what one robot does in a round: the first of its alternatives whose lock is free, or nothing.
struct Turn {
  uint32_t robot = 0;
  View inputs;                        ///< what its sensors said at the start of the round
  const Alternative* does = nullptr;  ///< nullptr: it skips
};

/// Presents a program to the protocol. All robots have the same one. Everything but `Contribute` is a pure
/// function of the store and the arguments.
class Program {
 public:
  virtual ~Program() = default;

  /// Appends what this robot does in a round, from the store and its sensors: a `Contribution`.
  virtual void Contribute(uint64_t round, Bytes& out) = 0;
  /// Reports whether `Apply` can carry out such a contribution of a robot. One without inputs and alternatives
  /// is always accepted: the robot's sensors stay as they were, and it skips.
  virtual bool Accepts(uint32_t robot, View inputs, std::span<const Alternative> alternatives) const = 0;
  /// Makes the store at the start of the next round: the sensors get what the inputs say, then all take their
  /// turns in this order. All turns were accepted.
  virtual void Apply(uint64_t round, std::span<const Turn> turns) = 0;
  /// Appends the whole store, in one and the same way for equal stores.
  virtual void Save(Bytes& out) const = 0;
  /// Replaces the store. Returns false, and leaves everything as it was, if these bytes are none.
  virtual bool Load(View bytes) = 0;
};

}  // namespace rondo::runtime::rounds
