#pragma once

#include <array>
#include <optional>
#include <variant>

#include "runtime/codec/bytes.h"

/// The messages of the round protocol (docs/runtime.md, "On the wire").
namespace rondo::runtime::codec {

constexpr size_t kMostRobots = 256;
constexpr size_t kMostPayload = size_t{64} << 20;  ///< bytes of a frame or a store
constexpr size_t kPart = 1000;                     ///< bytes of a payload that travel in one datagram
constexpr size_t kMostDatagram = 60'000;
constexpr uint64_t kMostNumber = uint64_t{1}
                                 << 62;  ///< of epochs, rounds, ballots and lives; no sum of two overflows

/// Names a state of the shared store: the one at the start of a round, as reached in an epoch. Later epochs
/// come after all rounds of earlier ones.
struct Place {
  uint64_t epoch = 0;
  uint64_t round = 0;
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// Names one life of a robot, from its start to its crash.
struct Member {
  uint32_t robot = 0;
  uint64_t incarnation = 0;
  friend auto operator<=>(const Member&, const Member&) = default;
};

/// Holds what an epoch begins with; decided once for each epoch.
struct Decision {
  uint64_t epoch = 0;
  std::vector<Member> members;  ///< in order of their robots
  Place base;                   ///< the store that everybody goes on from
  uint64_t digest = 0;          ///< of that store
  friend bool operator==(const Decision&, const Decision&) = default;
};

/// Numbers the attempts to decide; of two, the greater wins. A life that forgot which numbers the one before it
/// used makes other ballots nevertheless.
struct Ballot {
  uint64_t number = 0;
  uint32_t robot = 0;
  uint64_t incarnation = 0;  ///< of that robot
  friend auto operator<=>(const Ballot&, const Ballot&) = default;
};

/// Is a set of members of an epoch, by their place in its list.
struct MemberSet {
  std::array<uint64_t, kMostRobots / 64> words{};
  bool Has(size_t member) const { return (words[member / 64] >> (member % 64) & 1) != 0; }
  void Add(size_t member) { words[member / 64] |= uint64_t{1} << (member % 64); }
  bool Empty() const { return *this == MemberSet(); }
  friend bool operator==(const MemberSet&, const MemberSet&) = default;
};

/// Says which store the sender has, and what it lacks.
struct Status {
  Place at;
  bool holds = false;     ///< it has that store; else it waits for it
  bool counts = false;    ///< and will not forget it, so that it counts towards a majority
  bool asks = false;      ///< it wants to know where the receiver is
  bool forwards = false;  ///< the receiver shall send what the sender lacks also of others
  bool final = false;     ///< a majority of the fleet has that store
  MemberSet lacks;        ///< whose frames of this round it does not have
  /// Says which parts it lacks of the store, if it does not hold it, else of the first frame that it lacks:
  /// bit k of `window` stands for part `from` + k.
  uint32_t from = 0;
  uint64_t window = UINT64_MAX;
  friend bool operator==(const Status&, const Status&) = default;
};

/// Names what travels in parts.
enum class What : uint8_t {
  kStore,
  kFrame,   ///< what one robot does in a round
  kFrames,  ///< those of all members, each a block, in order
};

/// Holds a part of one of these.
struct Part {
  What what = What::kStore;
  Place at;
  std::optional<Member> of;  ///< whose frame; nothing of all else
  uint64_t sum = 0;          ///< of the whole
  uint32_t index = 0, count = 1;
  View bytes;
};

/// Asks to decide an epoch; who answers no longer stores rounds of earlier ones.
struct Prepare {
  uint64_t epoch;
  Ballot ballot;
};
struct Promise {
  uint64_t epoch;
  Ballot ballot;
  std::optional<Ballot> accepted;
  std::optional<Decision> value;
  Place newest;         ///< the newest store that it has
  uint64_t digest = 0;  ///< of that
};
struct Accept {
  Ballot ballot;
  Decision value;
};
struct Accepted {
  uint64_t epoch;
  Ballot ballot;
};
/// Says that an attempt came too late: a greater ballot was promised.
struct Refusal {
  uint64_t epoch;
  Ballot promised;
};
struct Decided {
  Decision value;
};

using Body = std::variant<Status, Part, Prepare, Promise, Accept, Accepted, Refusal, Decided>;

/// Holds one datagram.
struct Message {
  uint64_t agreement =
      0;  ///< sum of what all robots must have in common: program, parameters, fleet, version
  uint64_t session = 0;
  Member sender;
  Body body;
};

/// Says why bytes are no message.
enum class Refused : uint8_t {
  kNothing,
  kDamaged,  ///< too short, or its sum is wrong
  kForeign,  ///< of another program, fleet or version
  kSession,  ///< of another session
  kMalformed,
};

/// Appends a message to `out`, with a sum in front.
void Encode(const Message& message, Bytes& out);

/// Reads a message; parts point into `bytes`. `agreement` and `session` have to be these.
/// @param robots  how many there are; no message mentions others.
Refused Decode(View bytes, uint64_t agreement, uint64_t session, size_t robots, Message& message);

/// Writes and reads decisions and ballots, also for the disk.
void Write(Writer& writer, const Decision& decision);
Decision ReadDecision(Reader& reader, size_t robots);
void Write(Writer& writer, Place place);
Place ReadPlace(Reader& reader);
void Write(Writer& writer, Ballot ballot);
Ballot ReadBallot(Reader& reader, size_t robots);

}  // namespace rondo::runtime::codec
