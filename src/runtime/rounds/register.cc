#include "runtime/rounds/register.h"

namespace rondo::runtime::rounds {

bool Voter::Prepare(Ballot ballot) {
  if (promised && ballot < *promised) return false;
  promised = ballot;
  return true;
}

bool Voter::Accept(Ballot ballot, const Decision& decision) {
  if (promised && ballot < *promised) return false;
  promised = accepted = ballot;
  value = decision;
  return true;
}

void Voter::Reset(uint64_t next) {
  *this = Voter();
  epoch = next;
}

Attempt::Attempt(uint64_t epoch, Ballot ballot, size_t robots, size_t quorum)
    : epoch_(epoch), ballot_(ballot), quorum_(quorum), promised_(robots), accepted_(robots) {}

bool Attempt::Promised(uint32_t robot, const codec::Promise& promise) {
  if (promised_[robot] || promises_ >= quorum_) return false;
  promised_[robot] = true;
  if (promises_++ == 0 || promise.newest > newest_) {
    newest_ = promise.newest;
    digest_ = promise.digest;
  }
  if (promise.accepted && (!highest_ || *promise.accepted > *highest_)) {
    highest_ = promise.accepted;
    bound_ = promise.value;
  }
  return promises_ == quorum_;
}

bool Attempt::Accepted(uint32_t robot) {
  if (!value_ || accepted_[robot]) return false;
  accepted_[robot] = true;
  return ++votes_ == quorum_;
}

}  // namespace rondo::runtime::rounds
