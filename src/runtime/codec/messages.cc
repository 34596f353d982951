#include "runtime/codec/messages.h"

#include <algorithm>

namespace rondo::runtime::codec {
namespace {

constexpr uint8_t kMagic = 0xd0, kVersion = 2;
constexpr size_t kSum = 8;
constexpr size_t kMostParts = kMostPayload / kPart + 1;

void Write(Writer& w, Member m) {
  w.Number(m.robot);
  w.Number(m.incarnation);
}
Member ReadMember(Reader& r, size_t robots) {
  Member m;
  m.robot = static_cast<uint32_t>(r.Number(robots - 1));
  m.incarnation = r.Number(kMostNumber);
  return m;
}
// Of what is decided: the first epoch is 1.
uint64_t ReadEpoch(Reader& r) {
  const uint64_t epoch = r.Number(kMostNumber);
  if (epoch == 0) r.Fail();
  return epoch;
}
bool ReadFlag(Reader& r) { return r.Number(1) != 0; }

void Put(Writer& w, const MemberSet& set) {
  size_t used = set.words.size();
  while (used > 0 && set.words[used - 1] == 0) --used;
  w.Number(used);
  for (size_t i = 0; i < used; ++i) w.Number(set.words[i]);
}
void Get(Reader& r, MemberSet& set) {
  const size_t used = r.Number(set.words.size());
  for (size_t i = 0; i < used; ++i) set.words[i] = r.Number();
  if (used > 0 && set.words[used - 1] == 0) r.Fail();
}

constexpr uint8_t kHolds = 1, kCounts = 2, kAsks = 4, kForwards = 8, kFinal = 16, kWindow = 32;

void Put(Writer& w, const Status& s) {
  const bool window = s.from != 0 || s.window != UINT64_MAX;
  Write(w, s.at);
  w.Byte(static_cast<uint8_t>((s.holds ? kHolds : 0) | (s.counts ? kCounts : 0) | (s.asks ? kAsks : 0) |
                              (s.forwards ? kForwards : 0) | (s.final ? kFinal : 0) |
                              (window ? kWindow : 0)));
  Put(w, s.lacks);
  if (!window) return;
  w.Number(s.from);
  w.Fixed(s.window);
}
void Get(Reader& r, size_t, Status& s) {
  s.at = ReadPlace(r);
  const uint8_t flags = r.Byte();
  if (flags >= 2 * kWindow) r.Fail();
  s.holds = (flags & kHolds) != 0;
  s.counts = (flags & kCounts) != 0;
  s.asks = (flags & kAsks) != 0;
  s.forwards = (flags & kForwards) != 0;
  s.final = (flags & kFinal) != 0;
  Get(r, s.lacks);
  if ((flags & kWindow) == 0) return;
  s.from = static_cast<uint32_t>(r.Number(kMostParts));
  s.window = r.Fixed();
  if (s.from == 0 && s.window == UINT64_MAX) r.Fail();
}

void Put(Writer& w, const Part& p) {
  Write(w, p.at);
  w.Byte(static_cast<uint8_t>(p.what));
  if (p.of) Write(w, *p.of);
  w.Fixed(p.sum);
  w.Number(p.index);
  w.Number(p.count);
  w.Block(p.bytes);
}
void Get(Reader& r, size_t robots, Part& p) {
  p.at = ReadPlace(r);
  p.what = static_cast<What>(r.Number(static_cast<uint64_t>(What::kFrames)));
  if (p.what == What::kFrame) p.of = ReadMember(r, robots);
  p.sum = r.Fixed();
  p.index = static_cast<uint32_t>(r.Number(kMostParts));
  p.count = static_cast<uint32_t>(r.Number(kMostParts));
  p.bytes = r.Block(kPart);
  // All parts but the last are full, so that each whole is cut in one way.
  if (p.index >= p.count || (p.index + 1 < p.count && p.bytes.size() != kPart)) r.Fail();
  if (p.index + 1 == p.count && p.bytes.empty() && p.count > 1) r.Fail();
}

void Put(Writer& w, const Prepare& p) {
  w.Number(p.epoch);
  Write(w, p.ballot);
}
void Get(Reader& r, size_t robots, Prepare& p) {
  p.epoch = ReadEpoch(r);
  p.ballot = ReadBallot(r, robots);
}

void Put(Writer& w, const Promise& p) {
  w.Number(p.epoch);
  Write(w, p.ballot);
  w.Byte(p.accepted ? 1 : 0);
  if (p.accepted) {
    Write(w, *p.accepted);
    Write(w, *p.value);
  }
  Write(w, p.newest);
  w.Fixed(p.digest);
}
void Get(Reader& r, size_t robots, Promise& p) {
  p.epoch = ReadEpoch(r);
  p.ballot = ReadBallot(r, robots);
  if (ReadFlag(r)) {
    p.accepted = ReadBallot(r, robots);
    p.value = ReadDecision(r, robots);
    if (p.value->epoch != p.epoch) r.Fail();
  }
  p.newest = ReadPlace(r);
  p.digest = r.Fixed();
}

void Put(Writer& w, const Accept& a) {
  Write(w, a.ballot);
  Write(w, a.value);
}
void Get(Reader& r, size_t robots, Accept& a) {
  a.ballot = ReadBallot(r, robots);
  a.value = ReadDecision(r, robots);
}

void Put(Writer& w, const Accepted& a) {
  w.Number(a.epoch);
  Write(w, a.ballot);
}
void Get(Reader& r, size_t robots, Accepted& a) {
  a.epoch = ReadEpoch(r);
  a.ballot = ReadBallot(r, robots);
}

void Put(Writer& w, const Refusal& f) {
  w.Number(f.epoch);
  Write(w, f.promised);
}
void Get(Reader& r, size_t robots, Refusal& f) {
  f.epoch = ReadEpoch(r);
  f.promised = ReadBallot(r, robots);
}

void Put(Writer& w, const Decided& d) { Write(w, d.value); }
void Get(Reader& r, size_t robots, Decided& d) { d.value = ReadDecision(r, robots); }

template <size_t I = 0>
void GetBody(Reader& r, size_t robots, size_t kind, Body& body) {
  if constexpr (I < std::variant_size_v<Body>) {
    if (kind != I) return GetBody<I + 1>(r, robots, kind, body);
    std::variant_alternative_t<I, Body> read{};
    Get(r, robots, read);
    body = std::move(read);
  } else {
    r.Fail();
  }
}

}  // namespace

void Write(Writer& w, Place place) {
  w.Number(place.epoch);
  w.Number(place.round);
}
Place ReadPlace(Reader& r) {
  Place place;
  place.epoch = r.Number(kMostNumber);
  place.round = r.Number(kMostNumber);
  return place;
}

void Write(Writer& w, Ballot ballot) {
  w.Number(ballot.number);
  w.Number(ballot.robot);
  w.Number(ballot.incarnation);
}
Ballot ReadBallot(Reader& r, size_t robots) {
  Ballot ballot;
  ballot.number = r.Number(kMostNumber);
  ballot.robot = static_cast<uint32_t>(r.Number(robots - 1));
  ballot.incarnation = r.Number(kMostNumber);
  return ballot;
}

void Write(Writer& w, const Decision& d) {
  w.Number(d.epoch);
  w.Number(d.members.size());
  for (const Member& m : d.members) Write(w, m);
  Write(w, d.base);
  w.Fixed(d.digest);
}
Decision ReadDecision(Reader& r, size_t robots) {
  Decision d;
  d.epoch = r.Number(kMostNumber);
  const size_t count = r.Number(robots);
  for (size_t i = 0; i < count && r.ok(); ++i) {
    d.members.push_back(ReadMember(r, robots));
    if (i > 0 && d.members[i - 1].robot >= d.members[i].robot) r.Fail();
  }
  d.base = ReadPlace(r);
  d.digest = r.Fixed();
  // An epoch goes on from one before it.
  if (d.epoch == 0 || d.members.empty() || d.base.epoch >= d.epoch) r.Fail();
  return d;
}

void Encode(const Message& message, Bytes& out) {
  const size_t start = out.size();
  out.resize(start + kSum);
  Writer w(out);
  w.Byte(kMagic);
  w.Byte(kVersion);
  w.Fixed(message.agreement);
  w.Fixed(message.session);
  Write(w, message.sender);
  w.Byte(static_cast<uint8_t>(message.body.index()));
  std::visit([&](const auto& body) { Put(w, body); }, message.body);
  const uint64_t sum = Sum(View(out).subspan(start + kSum));
  for (size_t i = 0; i < kSum; ++i) out[start + i] = static_cast<uint8_t>(sum >> (8 * i));
}

Refused Decode(View bytes, uint64_t agreement, uint64_t session, size_t robots, Message& message) {
  if (bytes.size() < kSum || bytes.size() > kMostDatagram) return Refused::kDamaged;
  Reader r(bytes);
  if (r.Fixed() != Sum(bytes.subspan(kSum))) return Refused::kDamaged;
  if (r.Byte() != kMagic) return Refused::kMalformed;
  if (r.Byte() != kVersion) return Refused::kForeign;
  message.agreement = r.Fixed();
  message.session = r.Fixed();
  if (!r.ok()) return Refused::kMalformed;
  if (message.agreement != agreement) return Refused::kForeign;
  if (message.session != session) return Refused::kSession;
  message.sender = ReadMember(r, robots);
  const uint8_t kind = r.Byte();
  GetBody(r, robots, kind, message.body);
  return r.Complete() ? Refused::kNothing : Refused::kMalformed;
}

}  // namespace rondo::runtime::codec
