#include <algorithm>
#include <utility>

#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

// Repetitions are fast at first, and slower the longer nothing happens.
void Core::Progress() {
  progress_at_ = now_;
  interval_ = settings_.resend;
  resend_at_ = now_ + interval_;
  attempt_ = 0;
}

Time Core::SlowestRepetition() const { return std::max(settings_.resend, settings_.patience / 16); }

bool Core::Waits() const { return phase_ != Phase::kCommitted || trial_; }

codec::Status Core::MyStatus(bool asks, bool forwards) const {
  codec::Status status;
  status.at = place_;
  status.holds = rank_ >= 0 && held_ == place_;
  status.counts = status.holds && !disk_failed_;
  status.asks = asks;
  status.forwards = forwards;
  status.final = rank_ >= 0 && (phase_ == Phase::kCommitted || phase_ == Phase::kCollecting);
  if (!status.holds) {
    base_.Missing(status.from, status.window);
  } else if (phase_ == Phase::kCollecting || attempt_ > 0) {
    // Before it has begun, too: the frames of others say that it may.
    for (size_t k = frames_.size(); k-- > 0;) {
      if (frames_[k].complete()) continue;
      status.lacks.Add(k);
      frames_[k].Missing(status.from, status.window);
    }
  }
  return status;
}

void Core::SendStatus() {
  // What goes over one robot goes over it at first. Who hears nothing of it for long asks the others.
  const bool collecting = phase_ == Phase::kCollecting;
  const auto& hub = collecting ? collector_ : counter_;
  if (hub && attempt_ == 0) {
    if (hub != settings_.self) Post(*hub, MyStatus(false, false));
    return;
  }
  const bool others =
      collecting ? settings_.parts.memory->AsksOthers() : settings_.parts.barrier->AsksOthers();
  const bool patient = !others && Silence() < settings_.patience / 2;
  // One that began another life is in the middle of nothing.
  const bool there = hub && hub != settings_.self && RankOf({*hub, peers_[*hub].incarnation}) >= 0;
  if (there && phase_ != Phase::kFetching && (attempt_ < 2 || patient))
    return Post(*hub, MyStatus(true, collecting));
  Post(kAll, MyStatus(attempt_ > 0, false));
  // Whose sender is silent may be with somebody else; one is asked after the other.
  if (attempt_ == 0 || settings_.robots == 1 || rank_ < 0) return;
  if (phase_ != Phase::kFetching && attempt_ < 2) return;
  const uint32_t rest = settings_.robots - 1;
  Post((settings_.self + 1 + attempt_ % rest) % settings_.robots, MyStatus(false, true));
}

void Core::Repeat() {
  if (!Waits() || now_ < resend_at_) return;
  ++attempt_;
  // Most of what a bad radio loses is there after three more attempts.
  if (attempt_ >= 3) interval_ = std::min(2 * interval_, SlowestRepetition());
  resend_at_ = now_ + interval_;
  if (disk_failed_) KeepRecord();
  SendStatus();
  if (trial_) VoteForOwn();
  if (trial_) Ask();
}

// What the sender lacks, as far as it is here.
void Core::Serve(Member from, const codec::Status& status) {
  if (decision_ && status.at.epoch < Epoch()) Post(from.robot, codec::Decided{*decision_});
  if (decision_ && status.at.epoch == Epoch() && rank_ >= 0) {
    if (!status.holds) {
      if (status.forwards && status.at == place_ && held_ == place_) {
        ForParts(codec::What::kStore, place_, std::nullopt, store_, status.from, status.window,
                 [&](const codec::Part& part) { Post(from.robot, part); });
      }
    } else if (status.at == place_) {
      SendFrames(from.robot, frames_, place_, status);
    } else if (status.at.round + 1 == place_.round) {
      SendFrames(from.robot, before_, status.at, status);
    }
  }
  if (status.asks || status.at.epoch > Epoch()) Post(from.robot, MyStatus(false, false));
}

void Core::SendFrames(uint32_t to, const std::vector<Assembly>& frames, Place at,
                      const codec::Status& status) {
  bool first = true;
  for (size_t k = 0; k < frames.size(); ++k) {
    if (!status.lacks.Has(k)) continue;
    const bool window = std::exchange(first, false);
    const bool mine = static_cast<int>(k) == rank_;
    if (!frames[k].complete() || (!mine && !status.forwards)) continue;
    ForParts(codec::What::kFrame, at, decision_->members[k], frames[k].whole(), window ? status.from : 0,
             window ? status.window : UINT64_MAX, [&](const codec::Part& part) { Post(to, part); });
  }
}

}  // namespace rondo::runtime::rounds
