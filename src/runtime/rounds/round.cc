#include <algorithm>

#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

// Says what this robot does in the round; the store that it starts from is committed.
void Core::Begin() {
  round_start_ = first_sent_ = now_;
  asked_in_epoch_ = true;
  phase_ = Phase::kCollecting;
  Bytes payload;
  program_->Contribute(place_.round, payload);
  // What others would refuse must not be merged here alone: then the robot does nothing.
  const auto mine = Decode(View(payload));
  if (!mine || !program_->Accepts(settings_.self, mine->inputs, mine->alternatives)) {
    ++refused_[static_cast<size_t>(codec::Refused::kMalformed)];
    payload.clear();
    Encode(Contribution(), payload);
  }
  outputs_->push_back(Contributed{place_, payload});
  frames_[static_cast<size_t>(rank_)].Set(std::move(payload));
  Progress();
  const Member self{settings_.self, settings_.incarnation};
  ForParts(place_, self, frames_[static_cast<size_t>(rank_)].whole(), 0, UINT64_MAX,
           [&](const codec::Part& part) { Post(kAll, part); });
  TryMerge();
}

void Core::TryMerge() {
  if (phase_ != Phase::kCollecting) return;
  if (!std::ranges::all_of(frames_, [](const Assembly& f) { return f.complete(); })) return;
  // Who promised to decide on the next epoch stores nothing more in this one: the decision may not know it.
  if (voter_.promised) return;
  std::vector<Contribution> contributions;
  for (const Assembly& frame : frames_) contributions.push_back(*Decode(View(frame.whole())));
  program_->Apply(place_.round, Merge(place_.round, members_, contributions));
  before_ = std::move(frames_);
  frames_.assign(members_.size(), {});
  ++place_.round;
  StoreNow();
}

void Core::StoreNow() {
  held_ = place_;
  store_.clear();
  program_->Save(store_);
  digest_ = codec::Sum(store_);
  phase_ = Phase::kStored;
  KeepRecord();
  outputs_->push_back(Stored{place_, digest_});
  Progress();
  SendStatus();
  TryCommit();
}

// A store is committed when a majority of the fleet has it: no later epoch can miss it then.
void Core::TryCommit() {
  if (phase_ != Phase::kStored || now_ < not_before_) return;
  uint32_t count = disk_failed_ ? 0 : 1;
  bool began = false;
  for (const Peer& peer : peers_) {
    if (peer.at.epoch != place_.epoch || peer.at.round < place_.round) continue;
    if (peer.holds && peer.counts) ++count;
    began = began || peer.began || peer.at.round > place_.round;
  }
  if (!began && !Majority(count)) return;
  phase_ = Phase::kCommitted;
  outputs_->push_back(Committed{place_});
  Progress();
  // The answer is to a frame that was sent in this epoch: those who decide on the next one know when.
  if (asked_in_epoch_) lease_end_ = std::max(lease_end_, first_sent_ + settings_.lease);
  if (!asked_in_epoch_ || now_ >= lease_end_) return;
  active_ = acted_ = true;
  outputs_->push_back(Act{place_, lease_end_});
}

void Core::EndLease() {
  if (!active_ || now_ < lease_end_) return;
  active_ = false;
  outputs_->push_back(FallBack{});
  if (settings_.on_loss == OnLoss::kHalt) phase_ = Phase::kHalted;
}

}  // namespace rondo::runtime::rounds
