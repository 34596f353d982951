#include <algorithm>

#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

namespace {

using codec::Writer;

template <typename T, typename Put>
void Maybe(Writer& w, const std::optional<T>& value, const Put& put) {
  w.Byte(value ? 1 : 0);
  if (value) put(*value);
}

}  // namespace

void Assembly::Describe(codec::Writer& w) const {
  w.Block(whole_);
  w.Number(has_.size());
  for (const bool has : has_) w.Byte(has ? 1 : 0);
  w.Fixed(sum_);
  w.Byte(complete_ ? 1 : 0);
}

void Attempt::Describe(codec::Writer& w) const {
  w.Number(epoch_);
  codec::Write(w, ballot_);
  for (size_t r = 0; r < promised_.size(); ++r)
    w.Byte(static_cast<uint8_t>((promised_[r] ? 1 : 0) | (accepted_[r] ? 2 : 0)));
  Maybe(w, highest_, [&](const Ballot& b) { codec::Write(w, b); });
  Maybe(w, bound_, [&](const Decision& d) { codec::Write(w, d); });
  codec::Write(w, newest_);
  w.Fixed(digest_);
  Maybe(w, value_, [&](const Decision& d) { codec::Write(w, d); });
}

Core::Core(const Core& other, Program& program, Disk* disk) : Core(other) {
  program_ = &program;
  disk_ = disk;
}

void Core::Describe(Bytes& out) const {
  Writer w(out);
  // Moments as they lie from now. Of what is over, it does not matter since when.
  const auto ahead = [&](Time time) { w.Number(static_cast<uint64_t>(std::max<Time>(0, time - now_))); };
  const auto behind = [&](Time time, Time most) {
    w.Number(static_cast<uint64_t>(std::min(std::max<Time>(0, now_ - time), most)));
  };
  const Time long_ago = settings_.lease + 2 * settings_.patience;
  w.Byte(static_cast<uint8_t>(phase_));
  w.Byte(static_cast<uint8_t>((started_ ? 1 : 0) | (asked_in_epoch_ ? 2 : 0) | (active_ ? 4 : 0) |
                              (votes_ ? 8 : 0) | (disk_failed_ ? 16 : 0) | (wanted_ ? 32 : 0)));
  Maybe(w, decision_, [&](const Decision& d) { codec::Write(w, d); });
  codec::Write(w, place_);
  codec::Write(w, held_);
  w.Block(store_);
  for (const Assembly& frame : frames_) frame.Describe(w);
  w.Byte(0xfe);
  for (const Assembly& frame : before_) frame.Describe(w);
  bundle_.Describe(w);
  base_.Describe(w);
  behind(round_start_, settings_.delta);
  behind(first_sent_, settings_.lease);
  ahead(lease_end_);
  ahead(not_before_);
  for (const Peer& peer : peers_) {
    w.Number(peer.incarnation);
    w.Byte(static_cast<uint8_t>((peer.heard ? 1 : 0) | (peer.holds ? 2 : 0) | (peer.counts ? 4 : 0) |
                                (peer.final ? 8 : 0)));
    behind(peer.last, settings_.patience + 1);
    codec::Write(w, peer.at);
  }
  ahead(resend_at_);
  w.Number(static_cast<uint64_t>(interval_));
  w.Number(attempt_);
  behind(std::max(progress_at_, not_before_), long_ago);
  behind(progress_at_, long_ago);
  Maybe(w, merged_at_, [&](Time at) { behind(at, settings_.patience + 1); });
  Maybe(w, voter_.promised, [&](const Ballot& b) { codec::Write(w, b); });
  Maybe(w, voter_.accepted, [&](const Ballot& b) { codec::Write(w, b); });
  Maybe(w, voter_.value, [&](const Decision& d) { codec::Write(w, d); });
  Maybe(w, trial_, [&](const Attempt& a) { a.Describe(w); });
  w.Number(highest_ballot_);
  ahead(try_at_);
  behind(tried_at_, settings_.patience << 5);
  ahead(give_way_until_);
  w.Number(tries_);
}

}  // namespace rondo::runtime::rounds
