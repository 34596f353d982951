#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Runs what one robot does of a choreography: synchronous messages and motions that messages may end. A deterministic
/// machine: no thread, clock, socket or random number is in it (docs/choreographies.md).
namespace rondo::runtime::sessions {

/// Counts nanoseconds since the session began, on the robot's own clock.
using Time = int64_t;

/// Is what travels between two robots. Both kinds may be lost, doubled and overtake each other.
struct Frame {
  /// An offer is the message itself, sent again until it is taken. It is taken when the receiver's program consumes it,
  /// not when it arrives: that is what makes messages synchronous.
  enum class Kind : uint8_t { kOffer, kTaken };
  Kind kind = Kind::kOffer;
  uint64_t session = 0;
  uint32_t from = 0, to = 0;   ///< robots by number; a kTaken goes back from the receiver
  uint64_t number = 0;         ///< of the message among those from its sender to its receiver
  std::string label;           ///< kOffer
  std::vector<double> values;  ///< kOffer: what it carries, in SI units; points take three, bools are 0 or 1
};

/// Names a message that a robot waits for.
struct Expected {
  uint32_t from = 0;
  std::string label;
};

/// Is what a robot does next.
struct Step {
  enum class Kind : uint8_t {
    kSend,
    kReceive,
    kMove,
    kEnd,
    kFault,  ///< nothing can be done: no alternative of a choice holds, a value does not exist
  };
  Kind kind = Kind::kEnd;
  uint32_t to = 0;                ///< kSend
  std::string label;              ///< kSend; kFault: what is the matter
  std::vector<double> values;     ///< kSend
  std::vector<Expected> cases{};  ///< kReceive
  std::optional<size_t> motion;   ///< kMove; kReceive: what it does meanwhile
  /// kReceive: whether it does that again and again until a message comes. If not, it has moved when the motion is over, or
  /// some time after it has become ready to go on, and does what follows.
  bool again = true;
  bool ends = false;  ///< kReceive: if no message comes, it is at its end
};

/// Says what a robot does, step by step. Evaluates nothing before it is asked.
class Program {
 public:
  virtual ~Program() = default;
  /// Returns the present step. Is called once for each, when the robot may act: choices read what it senses then.
  virtual Step Next() = 0;
  /// Reports, of a step with a motion that is not done again, whether the robot waits for others behind it before it decides
  /// anything.
  virtual bool Waits() const = 0;
  /// Say that the present step is over. `Took`: by which of its cases, and what the message carried.
  virtual void Sent() = 0;
  virtual void Took(size_t which, const std::vector<double>& values) = 0;
  virtual void Moved() = 0;
};

/// Tells how far a motion is.
enum class Progress : uint8_t {
  kBound,    ///< it has to go on
  kOpen,     ///< a message may end it
  kReady,    ///< a message may end it, and the robot itself is content to go on with what follows
  kStopped,  ///< it is over: the robot stands as the motion's contract says
  kFailed,   ///< it cannot be completed
};

/// Moves the robot: one motion at a time.
class Motions {
 public:
  virtual ~Motions() = default;
  /// Begins a motion of the program, by its number.
  virtual void Begin(size_t motion) = 0;
  /// Returns how far the motion under way is.
  virtual Progress Tick() = 0;
  /// Ends the motion under way, which is open; it may be bound for a while until it has stopped.
  virtual void Halt() = 0;
};

/// Is the session of one robot. Thread-compatible.
class Session {
 public:
  /// @param resend  how long an offer waits for an answer before it is sent again
  Session(uint64_t session, uint32_t self, Time resend, Program& program, Motions& motions)
      : session_(session), self_(self), resend_(resend), program_(program), motions_(motions) {}

  /// Takes a frame in; what is not for this session and robot is ignored.
  void Hear(const Frame& frame);
  /// Goes on as far as it can at this instant. Returns whether any step was done or begun.
  bool Advance(Time now);
  /// Returns the frames to be sent, and forgets them.
  std::vector<Frame> TakeFrames();
  /// Returns when `Advance` has something to do even if nothing arrives and no motion gets on; nothing: never.
  std::optional<Time> Wake() const;

  /// Reports whether the program is at its end, unless a message comes. A motion that anybody may interrupt may go on then.
  bool ended() const;
  /// Reports whether a motion is under way.
  bool moving() const { return moving_; }
  /// Reports that nothing more happens here, because of a fault of the program or a motion that failed; `fault` is why.
  bool failed() const { return failed_; }
  const std::string& fault() const { return fault_; }
  /// Returns the present step, for people and for tests; nothing before the first `Advance`.
  const std::optional<Step>& step() const { return step_; }
  /// Reports whether the robot can do nothing by itself: it waits for messages that nobody has offered, in motions that
  /// anybody may end.
  bool idle() const;
  /// Count the messages that this robot sent to another one, taken or not, and those that it took from it.
  uint64_t SentTo(uint32_t robot) const { return CountOf(sent_, robot); }
  uint64_t TakenFrom(uint32_t robot) const { return CountOf(received_, robot); }

 private:
  static uint64_t CountOf(const std::map<uint32_t, uint64_t>& counts, uint32_t robot) {
    const auto it = counts.find(robot);
    return it == counts.end() ? 0 : it->second;
  }
  enum class Went : uint8_t { kOn, kNowhere };
  Went Move();
  Went Send();
  Went Receive();
  Went Fail(std::string why);
  void Done() { step_.reset(); }
  bool Stopped();
  bool Continues();
  bool MayBeInterrupted() const;
  const Frame* Offered(size_t& which) const;

  uint64_t session_;
  uint32_t self_;
  Time resend_;
  Program& program_;
  Motions& motions_;

  std::optional<Step> step_;
  bool moving_ = false;   // a motion is under way, of this step or still of one before
  bool begun_ = false;    // it is this step's
  bool halting_ = false;  // and has been told to stop
  Time began_ = 0;        // when this step's did
  Time now_ = 0;
  Progress progress_ = Progress::kStopped;
  bool ended_ = false, failed_ = false;
  std::string fault_;

  std::optional<Frame> offer_;  // what this robot sends now
  bool taken_ = false;
  Time again_ = 0;                         // when to send it again
  std::map<uint32_t, uint64_t> sent_;      // by receiver: messages so far
  std::map<uint32_t, uint64_t> received_;  // by sender: messages taken so far
  std::map<uint32_t, Frame> inbox_;        // by sender: its present offer
  std::vector<Frame> out_;
};

}  // namespace rondo::runtime::sessions
