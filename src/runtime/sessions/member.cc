#include "runtime/sessions/member.h"

#include <algorithm>

namespace rondo::runtime::sessions {

using codec::Bytes;
using codec::Refused;
using codec::View;

std::string_view Name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kOpen:
      return "open";
    case Outcome::kOver:
      return "over";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kLost:
      return "lost";
    case Outcome::kLeft:
      return "left";
    case Outcome::kStopped:
      return "stopped";
  }
  return "";
}

std::vector<Member::Letter> Member::Step(Time now, View datagram) {
  std::vector<Letter> out;
  if (!datagram.empty()) Hear(now, datagram, out);
  if (outcome_ == Outcome::kOpen) {
    if (phase_ == Phase::kGathering) Gather();
    if (phase_ == Phase::kRunning || phase_ == Phase::kEnded) Run(now, out);
    if (phase_ == Phase::kEnded || phase_ == Phase::kFinished) Finish(now);
  }
  if (now >= beats_ || answers_) {
    out.push_back({std::nullopt, BytesOf(Own())});
    beats_ = now + settings_.beat;
    answers_ = false;
  }
  wake_ = beats_;
  if (const auto resend = session_.Wake(); resend && outcome_ == Outcome::kOpen)
    wake_ = std::min(wake_, *resend);
  if (session_.moving() && outcome_ == Outcome::kOpen) wake_ = std::min(wake_, now + settings_.tick);
  return out;
}

void Member::Hear(Time now, View bytes, std::vector<Letter>& out) {
  Datagram datagram;
  switch (Decode(bytes, settings_.agreement, settings_.session, settings_.robots, datagram)) {
    case Refused::kNothing:
      break;
    case Refused::kDamaged:
    case Refused::kMalformed:
      ++damaged_;
      return;
    case Refused::kForeign:
      ++foreign_;
      return;
    case Refused::kSession:
      ++strange_;
      return;
  }
  const uint32_t from = datagram.sender.robot;
  if (from == settings_.self) return;
  Peer& peer = peers_[from];
  if (peer.incarnation && *peer.incarnation > datagram.sender.incarnation) return;
  if (peer.incarnation != datagram.sender.incarnation) {
    // It lost what it knew: where it is in its program, and which messages it took.
    if (phase_ != Phase::kGathering) {
      if (outcome_ == Outcome::kOpen) Lose(from, Trouble::kAgain);
      return;
    }
    peer = Peer();
    peer.incarnation = datagram.sender.incarnation;
    answers_ = true;
  }
  peer.heard = now;
  if (const auto* frame = std::get_if<Frame>(&datagram.body)) {
    // What comes before it runs is sent again.
    if (phase_ == Phase::kGathering || outcome_ != Outcome::kOpen) return;
    session_.Hear(*frame);
    for (const Frame& answer : session_.TakeFrames()) out.push_back({answer.to, BytesOf(answer)});
    return;
  }
  const auto& alive = std::get<Alive>(datagram.body);
  if (phase_ == Phase::kGathering && alive != peer.alive) answers_ = true;
  peer.alive = alive;
  if (outcome_ != Outcome::kOpen || phase_ == Phase::kFinished) return;
  if (alive.phase == Phase::kGone) Lose(from, Trouble::kGone);
  if (alive.phase == Phase::kStopped) Lose(from, Trouble::kStopped);
}

bool Member::All(const std::function<bool(const Peer&)>& holds) const {
  for (uint32_t r = 0; r < peers_.size(); ++r) {
    if (r != settings_.self && !holds(peers_[r])) return false;
  }
  return true;
}

// It begins as soon as it knows that all have heard of all. Who runs already knew that, too.
void Member::Gather() {
  if (!Missing().empty()) return;
  phase_ = Phase::kRunning;
  answers_ = true;
}

std::vector<uint32_t> Member::Missing() const {
  std::vector<uint32_t> unheard, deaf;
  for (uint32_t r = 0; r < peers_.size(); ++r) {
    if (r == settings_.self) continue;
    if (!peers_[r].incarnation) {
      unheard.push_back(r);
      continue;
    }
    if (peers_[r].alive.phase != Phase::kGathering) continue;
    for (uint32_t other = 0; other < peers_.size(); ++other) {
      if (other == r || peers_[r].alive.heard.Has(other)) continue;
      deaf.push_back(r);
      break;
    }
  }
  return unheard.empty() ? deaf : unheard;
}

void Member::Run(Time now, std::vector<Letter>& out) {
  for (uint32_t r = 0; r < peers_.size(); ++r) {
    if (r == settings_.self || now - peers_[r].heard <= settings_.patience) continue;
    Lose(r, Trouble::kSilent);
    return;
  }
  session_.Advance(now);
  for (const Frame& frame : session_.TakeFrames()) out.push_back({frame.to, BytesOf(frame)});
  if (session_.failed()) {
    End(Outcome::kFailed);
    return;
  }
  const Phase phase = session_.ended() ? Phase::kEnded : Phase::kRunning;
  if (phase != phase_) answers_ = true;
  phase_ = phase;
}

void Member::Finish(Time now) {
  if (phase_ == Phase::kEnded && AllAtTheirEnds()) {
    phase_ = Phase::kFinished;
    finished_ = now;
    answers_ = true;
  }
  if (phase_ != Phase::kFinished) return;
  const bool known = All([](const Peer& p) { return p.alive.phase >= Phase::kFinished; });
  if (known || now - finished_ > settings_.patience) {
    outcome_ = Outcome::kOver;
    answers_ = true;
  }
}

// What robots last said of themselves is a consistent cut if each message that one had sent was taken by the other: then none was
// on its way, and nobody who waits for one can get it any more.
bool Member::AllAtTheirEnds() const {
  std::vector<Alive> said;
  for (uint32_t r = 0; r < peers_.size(); ++r) {
    said.push_back(r == settings_.self ? Own() : peers_[r].alive);
    if (said.back().phase != Phase::kEnded && said.back().phase != Phase::kFinished) return false;
  }
  for (size_t a = 0; a < said.size(); ++a) {
    for (size_t b = 0; b < said.size(); ++b) {
      if (said[a].sent[b] != said[b].taken[a]) return false;
    }
  }
  return true;
}

void Member::Lose(uint32_t robot, Trouble trouble) {
  trouble_ = trouble;
  culprit_ = robot;
  End(trouble == Trouble::kStopped ? Outcome::kStopped : Outcome::kLost);
}

void Member::End(Outcome outcome) {
  outcome_ = outcome;
  phase_ = outcome == Outcome::kLeft || outcome == Outcome::kStopped ? Phase::kStopped : Phase::kGone;
  answers_ = true;
}

void Member::Leave() {
  if (outcome_ == Outcome::kOpen) End(Outcome::kLeft);
}

std::string Member::Why(const std::function<std::string(uint32_t)>& name) const {
  if (outcome_ == Outcome::kFailed) return session_.fault();
  switch (trouble_) {
    case Trouble::kNone:
      return {};
    case Trouble::kSilent:
      return name(culprit_) + " is silent";
    case Trouble::kGone:
      return name(culprit_) + " takes no part any more";
    case Trouble::kStopped:
      return name(culprit_) + " was stopped";
    case Trouble::kAgain:
      return name(culprit_) + " started again, and does not know where it was";
  }
  return {};
}

Alive Member::Own() const {
  Alive own;
  own.phase = phase_;
  for (uint32_t r = 0; r < peers_.size(); ++r) {
    if (r == settings_.self || peers_[r].incarnation) own.heard.Add(r);
    if (phase_ < Phase::kEnded) continue;
    own.sent.push_back(session_.SentTo(r));
    own.taken.push_back(session_.TakenFrom(r));
  }
  return own;
}

Bytes Member::BytesOf(std::variant<Alive, Frame> body) const {
  Bytes bytes;
  Encode({settings_.agreement, {settings_.self, settings_.incarnation}, std::move(body)}, settings_.session,
         bytes);
  return bytes;
}

}  // namespace rondo::runtime::sessions
