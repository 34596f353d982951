#include <algorithm>

#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

// Says what this robot does in the round; the store that it starts from is committed.
void Core::Begin() {
  round_start_ = first_sent_ = now_;
  asked_in_epoch_ = true;
  phase_ = Phase::kCollecting;
  Bytes& frame = frames_[static_cast<size_t>(rank_)].Make();
  program_->Contribute(place_.round, frame);
  // What others would refuse must not be merged here alone: then the robot does nothing.
  if (!Acceptable(settings_.self, View(frame))) {
    frame.clear();
    Encode(Contribution(), frame);
  }
  Contributed said{place_, outputs_->EmptyPayload()};
  said.payload.assign(frame.begin(), frame.end());
  outputs_->Add(std::move(said));
  Progress();
  const Member self{settings_.self, settings_.incarnation};
  // Whoever collects the frames says to all that the round has begun.
  const uint32_t to = collector_ == settings_.self ? kAll : collector_.value_or(kAll);
  ForParts(codec::What::kFrame, place_, self, frame, 0, UINT64_MAX,
           [&](const codec::Part& part) { Post(to, part); });
  TryMerge();
}

void Core::TryMerge() {
  if (phase_ != Phase::kCollecting) return;
  if (!std::ranges::all_of(frames_, [](const Assembly& f) { return f.complete(); })) return;
  // Who promised to decide on the next epoch stores nothing more in this one: the decision may not know it.
  if (voter_.promised) return;
  if (collector_ == settings_.self) PassOn();
  contributions_.resize(frames_.size());
  for (size_t k = 0; k < frames_.size(); ++k) Decode(View(frames_[k].whole()), contributions_[k]);
  Merge(place_.round, *settings_.parts.locks, members_, contributions_, turns_);
  program_->Apply(place_.round, turns_);
  std::swap(before_, frames_);
  frames_.resize(members_.size());
  for (Assembly& frame : frames_) frame.Clear();
  bundle_.Clear();
  merged_at_ = now_;
  ++place_.round;
  StoreNow();
}

// Sends the frames of all to all: as one whole, unless it has parts that nobody could ask for.
void Core::PassOn() {
  if (settings_.robots == 1) return;
  codec::Bytes& all = bundle_.Make();
  codec::Writer writer(all);
  for (const Assembly& frame : frames_) writer.Block(frame.whole());
  const auto send = [&](const codec::Part& part) { Post(kAll, part); };
  if (all.size() <= 64 * codec::kPart)
    return ForParts(codec::What::kFrames, place_, std::nullopt, all, 0, UINT64_MAX, send);
  for (size_t k = 0; k < frames_.size(); ++k) {
    if (static_cast<int>(k) == rank_) continue;
    ForParts(codec::What::kFrame, place_, decision_->members[k], frames_[k].whole(), 0, UINT64_MAX, send);
  }
}

// Is this what a member can say? Counts it if it is not.
bool Core::Acceptable(uint32_t robot, View frame) {
  if (Decode(frame, checked_) && program_->Accepts(robot, checked_.inputs, checked_.alternatives))
    return true;
  ++refused_[static_cast<size_t>(codec::Refused::kMalformed)];
  return false;
}

void Core::StoreNow() {
  held_ = place_;
  store_.clear();
  program_->Save(store_);
  digest_ = codec::Sum(store_);
  phase_ = Phase::kStored;
  KeepRecord();
  outputs_->Add(Stored{place_, digest_});
  Progress();
  SendStatus();
  TryCommit();
}

// A store is committed when a majority of the fleet has it: no later epoch can miss it then.
void Core::TryCommit() {
  if (phase_ != Phase::kStored || now_ < not_before_) return;
  uint32_t count = disk_failed_ ? 0 : 1;
  bool final = false;
  for (const Peer& peer : peers_) {
    if (peer.at.epoch != place_.epoch || peer.at.round < place_.round) continue;
    if (peer.holds && peer.counts) ++count;
    final = final || peer.final || peer.at.round > place_.round;
  }
  if (!final && !Majority(count)) return;
  phase_ = Phase::kCommitted;
  outputs_->Add(Committed{place_});
  Progress();
  if (counter_ == settings_.self && settings_.robots > 1) Post(kAll, MyStatus(false, false));
  // The answer is to a frame that was sent in this epoch: those who decide on the next one know when.
  if (asked_in_epoch_) lease_end_ = std::max(lease_end_, first_sent_ + settings_.lease);
  if (!asked_in_epoch_ || now_ >= lease_end_) return;
  active_ = acted_ = true;
  outputs_->Add(Act{place_, lease_end_});
}

void Core::EndLease() {
  if (!active_ || now_ < lease_end_) return;
  active_ = false;
  acted_ = true;
  outputs_->Add(FallBack{});
  if (settings_.on_loss == OnLoss::kHalt) phase_ = Phase::kHalted;
}

}  // namespace rondo::runtime::rounds
