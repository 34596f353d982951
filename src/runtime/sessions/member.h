#pragma once

#include <functional>

#include "runtime/sessions/wire.h"

namespace rondo::runtime::sessions {

/// Says how one robot takes part in a session. Times in nanoseconds, on its own clock.
struct MemberSettings {
  uint64_t session = 0;      ///< the same for all robots; another one for each run
  uint64_t agreement = 0;    ///< sum of what all robots must have in common
  uint64_t incarnation = 1;  ///< greater than in any life of this robot before
  uint32_t self = 0;
  size_t robots = 0;
  Time resend = 10'000'000;       ///< from an offer until it is sent again
  Time beat = 50'000'000;         ///< from one sign of life to the next
  Time patience = 1'000'000'000;  ///< without a sign of life of another robot, until this one gives up
  Time tick = 10'000'000;         ///< from one look at a motion to the next
};

/// Names what became of a session, for one robot.
enum class Outcome : uint8_t {
  kOpen,     ///< it goes on
  kOver,     ///< all are at their ends, and know it, or have had the time to hear of it
  kFailed,   ///< this robot cannot go on: a motion failed, a choice has no alternative
  kLost,     ///< another robot is silent, is gone, or started again
  kLeft,     ///< somebody asked this one to stop
  kStopped,  ///< somebody asked another one to stop
};
/// Returns `open`, `over`, `failed`, `lost`, `left` or `stopped`.
std::string_view Name(Outcome outcome);

/// Takes part in a session over a network that may lose, double, delay, exchange and damage datagrams: begins when all robots
/// have heard of all others, runs the `Session`, notices who is missing, and ends when all know that no message can come any more.
/// A deterministic machine, as `Session` is.
///
/// What is promised: messages are taken once each, in order, and by robots that agree on what they run. A robot that hears
/// nothing of another one for `patience` gives up, and says so; no crash of one robot lets another one wait for ever. When it has given up,
/// its program does nothing more: the shell around it lets the body fall back.
class Member {
 public:
  /// Program and motions outlive it. Not more than `codec::kMostRobots` robots.
  Member(const MemberSettings& settings, Program& program, Motions& motions)
      : settings_(settings),
        session_(settings.session, settings.self, settings.resend, program, motions),
        peers_(settings.robots) {}

  /// Is a datagram, and the robot it is for; nothing: for all.
  struct Letter {
    std::optional<uint32_t> to;
    codec::Bytes bytes;
  };

  /// Takes a datagram in, unless it is empty, and goes on as far as it can. Returns what is to be sent.
  std::vector<Letter> Step(Time now, codec::View datagram);
  /// Ends it: the next step tells the others.
  void Leave();
  /// Returns when `Step` has something to do even if nothing arrives.
  Time wake() const { return wake_; }

  Phase phase() const { return phase_; }
  Outcome outcome() const { return outcome_; }
  /// Says, for people, why it failed or was lost. Names of robots are as `NameOf` gives them.
  std::string Why(const std::function<std::string(uint32_t)>& name) const;
  const Session& session() const { return session_; }
  /// Lists, while it gathers, the robots that it has not heard of; without those, those that have not heard of all.
  std::vector<uint32_t> Missing() const;
  /// Count datagrams that were damaged, of other programs, and of other sessions.
  uint64_t damaged() const { return damaged_; }
  uint64_t foreign() const { return foreign_; }
  uint64_t strange() const { return strange_; }

 private:
  struct Peer {
    std::optional<uint64_t> incarnation;  // nothing: not heard of
    Time heard = 0;
    Alive alive;
  };
  enum class Trouble : uint8_t { kNone, kSilent, kGone, kAgain, kStopped };
  void Hear(Time now, codec::View bytes, std::vector<Letter>& out);
  void Gather();
  void Run(Time now, std::vector<Letter>& out);
  void Finish(Time now);
  void Lose(uint32_t robot, Trouble trouble);
  void End(Outcome outcome);
  bool AllAtTheirEnds() const;
  bool All(const std::function<bool(const Peer&)>& holds) const;
  Alive Own() const;
  codec::Bytes BytesOf(std::variant<Alive, Frame> body) const;

  MemberSettings settings_;
  Session session_;
  std::vector<Peer> peers_;
  Phase phase_ = Phase::kGathering;
  Outcome outcome_ = Outcome::kOpen;
  Trouble trouble_ = Trouble::kNone;
  uint32_t culprit_ = 0;
  Time wake_ = 0, beats_ = 0;
  Time finished_ = 0;
  bool answers_ = false;  // somebody has to hear of it at once
  uint64_t damaged_ = 0, foreign_ = 0, strange_ = 0;
};

}  // namespace rondo::runtime::sessions
