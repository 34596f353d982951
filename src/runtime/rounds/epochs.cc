#include <algorithm>

#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

namespace {

constexpr uint8_t kRecordVersion = 1;

}  // namespace

// The first epoch is decided by all robots, so that it is not decided twice unless all forget. Later ones are
// decided by a majority, of those who forgot nothing.
bool Core::MayVote(uint64_t epoch) const {
  if (phase_ == Phase::kHalted) return false;
  return epoch == 1 || votes_;
}

// Does a robot that is no member want to be one, and knows that it is none?
bool Core::MayJoin(uint32_t robot) const {
  if (robot == settings_.self) return rank_ < 0;
  const Peer& peer = peers_[robot];
  return Recent(robot) && peer.at.epoch == Epoch() && RankOf({robot, peer.incarnation}) < 0;
}

// How long nothing has gone on, though it could have.
Time Core::Silence() const { return now_ - std::max(progress_at_, not_before_); }

std::vector<Member> Core::Candidates() const {
  std::vector<Member> all;
  const bool collecting = phase_ == Phase::kCollecting;
  for (uint32_t r = 0; r < settings_.robots; ++r) {
    const Member member{r, r == settings_.self ? settings_.incarnation : peers_[r].incarnation};
    const int rank = RankOf(member);
    if (rank < 0) {
      if (decision_ ? MayJoin(r) : Recent(r)) all.push_back(member);
      continue;
    }
    // Who said what it does is there, be it that others forwarded it. Who is heard and does not say it for long cannot
    // hear us.
    const bool said = collecting && frames_[static_cast<size_t>(rank)].complete();
    const bool slow = collecting && !said && Silence() >= 2 * settings_.patience;
    // Over one robot nobody else is heard, but the round that is over had the frames of all.
    const bool took_part = merged_at_ && now_ - *merged_at_ <= settings_.patience;
    if (said || ((Recent(r) || took_part) && !slow)) all.push_back(member);
  }
  return all;
}

bool Core::Wanted() const {
  if (!MayVote(Epoch() + 1)) return false;
  const bool silent = Silence() >= settings_.patience;
  // A promise that came to nothing, or a store that nobody has any more.
  bool reason = !decision_ || ((voter_.promised || phase_ == Phase::kFetching) && silent);
  if (decision_ && settings_.on_loss == OnLoss::kHalt) return false;
  for (uint32_t r = 0; decision_ && r < settings_.robots; ++r) reason = reason || MayJoin(r);
  const bool lost = settings_.on_loss == OnLoss::kEvict && phase_ != Phase::kCommitted && silent;
  if (!reason && !lost) return false;
  const std::vector<Member> all = Candidates();
  if (!reason && decision_ && all == decision_->members) return false;
  const size_t candidates = all.size();
  if (!decision_ || settings_.on_loss == OnLoss::kWait) return candidates == settings_.robots;
  return Majority(static_cast<uint32_t>(candidates));
}

// With `halt` nobody is given up: who waits for others longer than any lease says that the session is over, be it
// that it never acted.
void Core::TryHalt() {
  if (settings_.on_loss != OnLoss::kHalt || !decision_ || phase_ == Phase::kCommitted) return;
  if (Silence() < settings_.lease + settings_.patience) return;
  active_ = false;
  phase_ = Phase::kHalted;
  outputs_->Add(FallBack{});
}

// Robots try one after the other, so that their attempts do not stop each other for ever.
Time Core::Turn() const {
  return 2 * settings_.resend * static_cast<Time>((settings_.self + Epoch()) % settings_.robots);
}

// When to try again what was refused: soon at first.
Time Core::Again() const {
  const Time pause = (2 * settings_.resend + Turn()) << std::min<uint32_t>(tries_, 5);
  return std::min(try_at_, now_ + pause);
}

// Who hears of an attempt that goes before its own lets it go on: with many robots and a bad radio, none would
// come to an end. Each robot gives way a little longer the more often it has tried, but not for ever: the other may
// not hear everybody.
void Core::GiveWay(codec::Ballot other) {
  if (trial_ && other < trial_->ballot()) return;
  const Time longest = tried_at_ + (settings_.patience << std::min<uint32_t>(tries_, 5));
  // Of few robots one comes to an end soon; of many, all have to have missed several repetitions.
  const Time usual =
      std::min<Time>(settings_.patience / 2, SlowestRepetition() * settings_.robots * settings_.robots / 16);
  give_way_until_ = std::min(now_ + usual, longest);
}

void Core::TryEpoch() {
  if (!Wanted()) {
    wanted_ = false;
    trial_.reset();
    return;
  }
  if (!wanted_) {
    wanted_ = true;
    tries_ = 0;
    try_at_ = now_ + Turn();
    tried_at_ = now_;
  }
  if (now_ < try_at_ || now_ < give_way_until_) return;
  // Who can keep nothing lets the ballots of others be: it would only make them begin again.
  if (disk_failed_) KeepRecord();
  if (disk_failed_) {
    try_at_ = now_ + SlowestRepetition();
    return;
  }
  ++tries_;
  tried_at_ = now_;
  try_at_ = now_ + settings_.patience / 2 + Turn();
  const uint64_t epoch = Epoch() + 1;
  const Ballot ballot{++highest_ballot_, settings_.self, settings_.incarnation};
  trial_.emplace(epoch, ballot, settings_.robots, epoch == 1 ? settings_.robots : settings_.majority());
  if (!voter_.Prepare(ballot)) return;
  KeepRecord();
  if (disk_failed_) {
    try_at_ = Again();
    return trial_.reset();
  }
  Ask();
  if (trial_->Promised(settings_.self, {epoch, ballot, voter_.accepted, voter_.value, held_, digest_}))
    Choose();
}

void Core::Ask() {
  if (trial_->value())
    Post(kAll, codec::Accept{trial_->ballot(), *trial_->value()});
  else
    Post(kAll, codec::Prepare{trial_->epoch(), trial_->ballot()});
}

void Core::On(Member from, const codec::Prepare& prepare) {
  highest_ballot_ = std::max(highest_ballot_, prepare.ballot.number);
  if (prepare.epoch <= Epoch()) return Post(from.robot, codec::Decided{*decision_});
  if (prepare.epoch > Epoch() + 1) return Post(from.robot, MyStatus(false, false));
  if (!MayVote(prepare.epoch)) return;
  if (!voter_.Prepare(prepare.ballot))
    return Post(from.robot, codec::Refusal{prepare.epoch, *voter_.promised});
  GiveWay(prepare.ballot);
  KeepRecord();
  if (disk_failed_) return;
  Post(from.robot,
       codec::Promise{prepare.epoch, prepare.ballot, voter_.accepted, voter_.value, held_, digest_});
}

void Core::On(Member from, const codec::Promise& promise) {
  if (!trial_ || promise.epoch != trial_->epoch() || promise.ballot != trial_->ballot()) return;
  try_at_ = std::max(try_at_, now_ + settings_.patience / 2);
  if (trial_->Promised(from.robot, promise)) Choose();
}

void Core::Choose() {
  if (trial_->bound()) {
    trial_->Propose(*trial_->bound());
  } else {
    if (!Wanted()) return trial_.reset();
    trial_->Propose({trial_->epoch(), Candidates(), trial_->newest(), trial_->digest()});
  }
  Ask();
  if (!voter_.Accept(trial_->ballot(), *trial_->value())) return;
  KeepRecord();
  VoteForOwn();
}

// Its own vote counts when it is kept, which may be later than those of others.
void Core::VoteForOwn() {
  if (disk_failed_ || !trial_->value() || voter_.accepted != trial_->ballot()) return;
  if (trial_->Accepted(settings_.self)) Vote();
}

void Core::On(Member from, const codec::Accept& accept) {
  const uint64_t epoch = accept.value.epoch;
  highest_ballot_ = std::max(highest_ballot_, accept.ballot.number);
  if (epoch <= Epoch()) return Post(from.robot, codec::Decided{*decision_});
  if (epoch > Epoch() + 1) return Post(from.robot, MyStatus(false, false));
  if (!MayVote(epoch)) return;
  if (!voter_.Accept(accept.ballot, accept.value))
    return Post(from.robot, codec::Refusal{epoch, *voter_.promised});
  GiveWay(accept.ballot);
  KeepRecord();
  if (!disk_failed_) Post(from.robot, codec::Accepted{epoch, accept.ballot});
}

void Core::On(Member from, const codec::Accepted& accepted) {
  if (!trial_ || accepted.epoch != trial_->epoch() || accepted.ballot != trial_->ballot()) return;
  try_at_ = std::max(try_at_, now_ + settings_.patience / 2);
  if (trial_->Accepted(from.robot)) Vote();
}

// The attempt has all votes that it needs.
void Core::Vote() {
  const Decision decision = *trial_->value();
  Post(kAll, codec::Decided{decision});
  Adopt(decision);
}

void Core::On(Member, const codec::Refusal& refusal) {
  highest_ballot_ = std::max(highest_ballot_, refusal.promised.number);
  if (trial_ && trial_->epoch() == refusal.epoch && trial_->ballot() < refusal.promised) try_at_ = Again();
}

void Core::On(Member, const codec::Decided& decided) { Adopt(decided.value); }

void Core::Adopt(const Decision& decision) {
  if (decision.epoch <= Epoch()) {
    if (decision_ && decision.epoch == Epoch() && decision != *decision_) Fail("two decisions for one epoch");
    return;
  }
  if (phase_ == Phase::kHalted) return;
  decision_ = decision;
  members_.clear();
  for (const Member& m : decision.members) members_.push_back(m.robot);
  rank_ = RankOf({settings_.self, settings_.incarnation});
  place_ = {decision.epoch, decision.base.round};
  frames_.assign(members_.size(), {});
  before_.clear();
  bundle_.Clear();
  base_.Clear();
  merged_at_.reset();
  collector_.reset();
  counter_.reset();
  if (rank_ >= 0) {
    collector_ = settings_.parts.memory->Collector(decision.epoch, decision.members);
    counter_ = settings_.parts.barrier->Counter(decision.epoch, decision.members);
  }
  asked_in_epoch_ = false;
  // The leases of those who were left behind end first.
  const Time rest = settings_.lease + settings_.stop_time;
  const Time wait = rest + (rest / 1'000'000 + 1) * 2 * settings_.drift_ppm;
  not_before_ = decision.epoch == 1 ? now_ : now_ + wait;
  voter_.Reset(decision.epoch + 1);
  highest_ballot_ = 0;
  trial_.reset();
  wanted_ = false;
  give_way_until_ = 0;
  outputs_->Add(Adopted{decision});
  Progress();
  if (rank_ < 0) {
    phase_ = Phase::kOutside;
    KeepRecord();
    return;
  }
  phase_ = Phase::kFetching;
  if (held_.round == decision.base.round && digest_ == decision.digest) return TakePart();
  KeepRecord();
  attempt_ = 1;
  SendStatus();
}

// All parts of the store that the epoch begins with are here.
void Core::Enter() {
  // Who promised to decide on the next epoch stores nothing more in this one.
  if (voter_.promised) return;
  const bool loaded = program_->Load(View(base_.whole()));
  base_.Clear();
  if (loaded) TakePart();
}

// It has the store of an epoch that admits it: the first round begins at once.
void Core::TakePart() {
  votes_ = true;
  round_start_ = now_ - settings_.delta;
  StoreNow();
}

void Core::KeepRecord() {
  if (disk_ == nullptr) return;
  Bytes& record = record_;
  record.clear();
  codec::Writer w(record);
  w.Byte(kRecordVersion);
  w.Fixed(settings_.agreement);
  w.Fixed(settings_.session);
  w.Byte(votes_ ? 1 : 0);
  w.Byte(decision_ ? 1 : 0);
  if (decision_) codec::Write(w, *decision_);
  w.Byte(static_cast<uint8_t>((voter_.promised ? 1 : 0) | (voter_.accepted ? 2 : 0)));
  if (voter_.promised) codec::Write(w, *voter_.promised);
  if (voter_.accepted) {
    codec::Write(w, *voter_.accepted);
    codec::Write(w, *voter_.value);
  }
  codec::Write(w, held_);
  w.Block(store_);
  w.Fixed(codec::Sum(record));
  disk_failed_ = !disk_->Keep(record);
}

void Core::Recall(View record) {
  if (record.size() < 8) return;
  codec::Reader sum(record.last(8));
  if (sum.Fixed() != codec::Sum(record.first(record.size() - 8))) return;
  codec::Reader r(record.first(record.size() - 8));
  if (r.Byte() != kRecordVersion) return;
  // A record of another session says nothing about this one.
  if (r.Fixed() != settings_.agreement || r.Fixed() != settings_.session) return;
  const bool votes = r.Number(1) != 0;
  std::optional<Decision> decision;
  if (r.Number(1) != 0) decision = codec::ReadDecision(r, settings_.robots);
  Voter voter;
  voter.Reset((decision ? decision->epoch : 0) + 1);
  const uint64_t has = r.Number(3);
  if ((has & 1) != 0) voter.promised = codec::ReadBallot(r, settings_.robots);
  if ((has & 2) != 0) {
    voter.accepted = codec::ReadBallot(r, settings_.robots);
    voter.value = codec::ReadDecision(r, settings_.robots);
  }
  const Place held = codec::ReadPlace(r);
  const View store = r.Block(codec::kMostPayload);
  if (!r.Complete() || !program_->Load(store)) return;
  votes_ = votes;
  decision_ = decision;
  voter_ = voter;
  held_ = held;
  store_.assign(store.begin(), store.end());
  digest_ = codec::Sum(store_);
  if (decision_) {
    for (const Member& m : decision_->members) members_.push_back(m.robot);
    frames_.assign(members_.size(), {});
    place_ = {decision_->epoch, 0};
  }
  if (voter_.promised) highest_ballot_ = voter_.promised->number;
}

}  // namespace rondo::runtime::rounds
