#include "runtime/sessions/session.h"

#include <utility>

namespace rondo::runtime::sessions {

void Session::Hear(const Frame& frame) {
  if (frame.session != session_ || frame.to != self_ || frame.from == self_) return;
  if (frame.kind == Frame::Kind::kTaken) {
    if (offer_ && offer_->to == frame.from && offer_->number == frame.number) taken_ = true;
    return;
  }
  const uint64_t next = received_[frame.from];
  // The answer to what was taken before got lost.
  if (frame.number < next)
    out_.push_back({Frame::Kind::kTaken, session_, self_, frame.from, frame.number, {}, {}});
  if (frame.number == next) inbox_.insert_or_assign(frame.from, frame);
}

bool Session::Advance(Time now) {
  now_ = now;
  bool went = false;
  while (!failed_ && !ended_) {
    if (!step_) {
      step_ = program_.Next();
      begun_ = false;
      went = true;
    }
    Went on = Went::kNowhere;
    switch (step_->kind) {
      case Step::Kind::kMove:
        on = Move();
        break;
      case Step::Kind::kSend:
        on = Send();
        break;
      case Step::Kind::kReceive:
        on = Receive();
        break;
      case Step::Kind::kEnd:
        ended_ = true;
        break;
      case Step::Kind::kFault:
        on = Fail(step_->label);
        break;
    }
    if (on == Went::kNowhere) break;
    went = true;
  }
  if (ended_ && moving_) Continues();
  return went;
}

std::vector<Frame> Session::TakeFrames() { return std::exchange(out_, {}); }

std::optional<Time> Session::Wake() const { return offer_ && !taken_ ? std::optional(again_) : std::nullopt; }

bool Session::MayBeInterrupted() const {
  return !moving_ || progress_ == Progress::kOpen || progress_ == Progress::kReady;
}

bool Session::ended() const {
  if (ended_) return true;
  size_t which = 0;
  return step_ && step_->kind == Step::Kind::kReceive && step_->ends && MayBeInterrupted() &&
         Offered(which) == nullptr;
}

bool Session::idle() const {
  if (ended() || failed_) return true;
  if (!step_ || step_->kind != Step::Kind::kReceive) return false;
  size_t which = 0;
  if (Offered(which) != nullptr) return false;
  const bool goes_on = moving_ && begun_ && !step_->again && !program_.Waits();
  return MayBeInterrupted() && !goes_on;
}

Session::Went Session::Fail(std::string why) {
  failed_ = true;
  fault_ = std::move(why);
  return Went::kOn;
}

// The motion under way goes on; false if it is over.
bool Session::Continues() {
  progress_ = motions_.Tick();
  if (progress_ == Progress::kStopped) moving_ = halting_ = false;
  return moving_;
}

// Ends the motion under way, if there is one. False while it is not yet over.
bool Session::Stopped() {
  if (!moving_) return true;
  if (!halting_) motions_.Halt();
  halting_ = true;
  return !Continues();
}

Session::Went Session::Move() {
  if (!begun_) {
    if (!Stopped()) return Went::kNowhere;
    motions_.Begin(*step_->motion);
    moving_ = begun_ = true;
  }
  Continues();
  if (progress_ == Progress::kFailed) return Fail("a motion failed");
  const bool over = progress_ == Progress::kStopped || progress_ == Progress::kReady ||
                    (progress_ == Progress::kOpen && program_.Waits());
  if (!over) return Went::kNowhere;
  program_.Moved();
  Done();
  return Went::kOn;
}

Session::Went Session::Send() {
  if (!offer_) {
    offer_ = Frame{Frame::Kind::kOffer, session_,     self_,        step_->to,
                   sent_[step_->to]++,  step_->label, step_->values};
    taken_ = false;
    again_ = now_;
  }
  if (!taken_) {
    if (now_ >= again_) {
      out_.push_back(*offer_);
      again_ = now_ + resend_;
    }
    if (moving_ && Continues() && progress_ == Progress::kFailed) return Fail("a motion failed");
    return Went::kNowhere;
  }
  if (!Stopped()) return Went::kNowhere;
  offer_.reset();
  program_.Sent();
  Done();
  return Went::kOn;
}

const Frame* Session::Offered(size_t& which) const {
  for (which = 0; which < step_->cases.size(); ++which) {
    const Expected& wanted = step_->cases[which];
    const auto it = inbox_.find(wanted.from);
    if (it != inbox_.end() && it->second.label == wanted.label) return &it->second;
  }
  return nullptr;
}

Session::Went Session::Receive() {
  if (moving_ && !halting_) {
    Continues();
    if (progress_ == Progress::kFailed) return Fail("a motion failed");
  }
  size_t which = 0;
  if (Offered(which) == nullptr) {
    // At the instant at which it begins, nobody knows yet whether a message comes.
    const bool onward = begun_ && !step_->again;
    if (onward && (!moving_ || (progress_ == Progress::kReady && now_ > began_ && !program_.Waits()))) {
      program_.Moved();
      Done();
      return Went::kOn;
    }
    if (moving_ || !step_->motion) return Went::kNowhere;
    motions_.Begin(*step_->motion);
    moving_ = begun_ = true;
    began_ = now_;
    Continues();
    return Went::kNowhere;
  }
  if (moving_ && !halting_ && progress_ == Progress::kBound) return Went::kNowhere;
  if (!Stopped()) return Went::kNowhere;
  const uint32_t from = step_->cases[which].from;
  const Frame taken = std::move(inbox_.extract(from).mapped());
  received_[from] = taken.number + 1;
  out_.push_back({Frame::Kind::kTaken, session_, self_, from, taken.number, {}, {}});
  program_.Took(which, taken.values);
  Done();
  return Went::kOn;
}

}  // namespace rondo::runtime::sessions
