#include "runtime/rounds/core.h"

#include <algorithm>

namespace rondo::runtime::rounds {

namespace {

constexpr Time kNever = INT64_MAX;

}  // namespace

std::string_view Name(Phase phase) {
  switch (phase) {
    case Phase::kOutside:
      return "outside";
    case Phase::kFetching:
      return "fetching";
    case Phase::kStored:
      return "stored";
    case Phase::kCommitted:
      return "committed";
    case Phase::kCollecting:
      return "collecting";
    case Phase::kHalted:
      return "halted";
  }
  return "";
}

Core::Core(const Settings& settings, Program& program, Disk* disk, std::optional<View> record)
    : settings_(settings), program_(&program), disk_(disk), peers_(settings.robots) {
  program_->Save(store_);
  digest_ = codec::Sum(store_);
  // What cannot be read is forgotten.
  if (record) Recall(*record);
}

void Core::Step(Time now, View datagram, Outputs& outputs) {
  now_ = std::max(now_, now);
  outputs_ = &outputs;
  if (settings_.robots > codec::kMostRobots || settings_.self >= settings_.robots) {
    if (phase_ != Phase::kHalted) Fail("no such robot, or too many");
    return Wake();
  }
  acted_ = false;
  if (!started_) {
    started_ = true;
    Progress();
    resend_at_ = now_;
  }
  EndLease();
  if (!datagram.empty()) Receive(datagram);
  Timers();
  Wake();
}

void Core::Post(uint32_t to, codec::Body body) {
  Send send{to, outputs_->Empty()};
  codec::Encode(
      {settings_.agreement, settings_.session, {settings_.self, settings_.incarnation}, std::move(body)},
      send.bytes);
  outputs_->Add(std::move(send));
}

void Core::Fail(const char* what) {
  if (active_) outputs_->Add(FallBack{});
  active_ = false;
  phase_ = Phase::kHalted;
  outputs_->Add(Broken{what});
}

bool Core::Recent(uint32_t robot) const {
  if (robot == settings_.self) return true;
  return peers_[robot].heard && now_ - peers_[robot].last <= settings_.patience;
}

int Core::RankOf(Member member) const {
  if (!decision_) return -1;
  const auto& all = decision_->members;
  const auto it = std::ranges::find(all, member);
  return it == all.end() ? -1 : static_cast<int>(it - all.begin());
}

void Core::Receive(View bytes) {
  const codec::Refused why =
      codec::Decode(bytes, settings_.agreement, settings_.session, settings_.robots, message_);
  ++refused_[static_cast<size_t>(why)];
  if (why != codec::Refused::kNothing || message_.sender.robot == settings_.self) return;
  Peer& peer = peers_[message_.sender.robot];
  if (message_.sender.incarnation < peer.incarnation) return;  // from an earlier life
  if (message_.sender.incarnation > peer.incarnation) {
    peer = Peer();
    peer.incarnation = message_.sender.incarnation;
  }
  peer.heard = true;
  peer.last = now_;
  std::visit([&](const auto& body) { On(message_.sender, body); }, message_.body);
}

void Core::On(Member from, const codec::Status& status) {
  Peer& peer = peers_[from.robot];
  // Datagrams overtake each other; nobody goes back.
  if (status.at > peer.at) {
    peer.at = status.at;
    peer.holds = peer.counts = peer.final = false;
  }
  if (status.at == peer.at) {
    peer.holds = peer.holds || status.holds;
    peer.counts = peer.counts || status.counts;
    peer.final = peer.final || status.final;
  }
  if (status.final) SeeFinal(status.at);
  TryCommit();
  Serve(from, status);
}

void Core::On(Member from, const codec::Part& part) {
  if (!decision_ || part.at.epoch != Epoch() || phase_ == Phase::kHalted) return;
  if (part.what == codec::What::kStore) {
    if (phase_ != Phase::kFetching || part.at != place_ || part.sum != decision_->digest) return;
    progress_at_ = now_;
    if (base_.Add(part)) Enter();
    return;
  }
  if (rank_ < 0 || part.at != place_ || held_ != place_) return;
  if (part.what == codec::What::kFrames) return Unpack(part);
  const int rank = RankOf(*part.of);
  if (rank < 0) return;
  if (*part.of == from) {
    // Who begins a round has seen that a majority stores its beginning.
    SeeFinal(part.at);
    Peer& peer = peers_[from.robot];
    if (part.at > peer.at) peer = {peer.incarnation, true, now_, part.at, false, false, false};
    if (part.at == peer.at) peer.holds = peer.final = true;
    TryCommit();
    // Who waits for the end of the round before begins with the first who does, so that nobody waits for anybody.
    if (phase_ == Phase::kCommitted) round_start_ = std::min(round_start_, now_ - settings_.delta);
  }
  Assembly& frame = frames_[static_cast<size_t>(rank)];
  // Nobody knows better what its frame is.
  if (*part.of == from && !frame.complete() && !frame.Fits(part)) frame.Clear();
  if (frame.complete() || !frame.Add(part)) return;
  if (Acceptable(part.of->robot, View(frame.whole())))
    TryMerge();
  else
    frame.Clear();
}

// Somebody calls the store of this place final: it has waited for the leases of those who are no members.
void Core::SeeFinal(Place at) {
  if (decision_ && at.epoch == Epoch()) not_before_ = std::min(not_before_, now_);
}

// The frames of all members: those that are not here yet are taken from it.
void Core::Unpack(const codec::Part& part) {
  if (!bundle_.complete() && !bundle_.Fits(part)) bundle_.Clear();
  if (bundle_.complete() || !bundle_.Add(part)) return;
  codec::Reader reader(View(bundle_.whole()));
  for (size_t k = 0; k < frames_.size(); ++k) {
    const View whole = reader.Block(codec::kMostPayload);
    if (!reader.ok()) break;
    if (frames_[k].complete() || !Acceptable(members_[k], whole)) continue;
    frames_[k].Make().assign(whole.begin(), whole.end());
  }
  bundle_.Clear();
  TryMerge();
}

void Core::Timers() {
  if (phase_ == Phase::kHalted) return;
  TryCommit();
  // Not in the step in which it acts or falls back: what surrounds it does that when the step is over, with the store and
  // the actuators that there are then.
  if (phase_ == Phase::kCommitted && !acted_ && now_ >= round_start_ + settings_.delta) Begin();
  Repeat();
  TryHalt();
  if (phase_ != Phase::kHalted) TryEpoch();
}

void Core::Wake() {
  wake_ = kNever;
  const auto at = [&](Time time) { wake_ = std::min(wake_, std::max(time, now_ + 1)); };
  if (active_) at(lease_end_);
  if (phase_ == Phase::kHalted) return;
  if (phase_ == Phase::kCommitted) at(round_start_ + settings_.delta);
  if (phase_ == Phase::kStored && now_ < not_before_) at(not_before_);
  if (Waits()) at(resend_at_);
  if (wanted_) at(std::max(try_at_, give_way_until_));
}

}  // namespace rondo::runtime::rounds
