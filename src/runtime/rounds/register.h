#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "runtime/codec/messages.h"

/// Decides what the next epoch begins with: a register that is written once (single-decree Paxos; Lamport,
/// "Paxos made simple", 2001).
namespace rondo::runtime::rounds {

using codec::Ballot;
using codec::Decision;
using codec::Place;

/// Is what a robot has bound itself to about one epoch, the next. Answers must not be sent before this is
/// where a crash cannot reach it, or the robot must not vote after a crash.
struct Voter {
  uint64_t epoch = 1;
  std::optional<Ballot> promised;
  std::optional<Ballot> accepted;
  std::optional<Decision> value;  ///< what was accepted

  /// Promises to accept nothing below this ballot, unless something greater was promised; returns whether.
  bool Prepare(Ballot ballot);
  /// Accepts the decision unless something greater was promised; returns whether.
  bool Accept(Ballot ballot, const Decision& decision);
  /// Begins with the register of another epoch.
  void Reset(uint64_t next);
};

/// Is one attempt to decide. What it proposes is what some promise says was accepted with the greatest
/// ballot; only if there is nothing, its own choice.
class Attempt {
 public:
  /// @param quorum  how many voters make a promise or a decision: any two quorums have a common voter.
  Attempt(uint64_t epoch, Ballot ballot, size_t robots, size_t quorum);

  uint64_t epoch() const { return epoch_; }
  Ballot ballot() const { return ballot_; }

  /// Takes a promise, each robot's once. Returns true when the quorum is complete with it.
  bool Promised(uint32_t robot, const codec::Promise& promise);
  /// Returns what was accepted with the greatest ballot among the promises; nothing if they are free.
  const std::optional<Decision>& bound() const { return bound_; }
  /// Returns the newest store of those who promised, and its digest.
  Place newest() const { return newest_; }
  uint64_t digest() const { return digest_; }

  /// Sets what is proposed; from then on votes count.
  void Propose(Decision value) { value_ = std::move(value); }
  const std::optional<Decision>& value() const { return value_; }
  /// Takes a vote, each robot's once. Returns true when it is decided with it.
  bool Accepted(uint32_t robot);
  /// Appends everything that it is (`Core::Describe`).
  void Describe(codec::Writer& writer) const;

 private:
  uint64_t epoch_;
  Ballot ballot_;
  size_t quorum_;
  std::vector<bool> promised_, accepted_;  // by robot
  size_t promises_ = 0, votes_ = 0;
  std::optional<Ballot> highest_;
  std::optional<Decision> bound_;
  Place newest_;
  uint64_t digest_ = 0;
  std::optional<Decision> value_;
};

}  // namespace rondo::runtime::rounds
