#include "runtime/sessions/wire.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace rondo::runtime::sessions {

using codec::Bytes;
using codec::Reader;
using codec::Refused;
using codec::View;
using codec::Writer;

namespace {

constexpr uint8_t kMagic = 0xd1, kVersion = 1;
constexpr size_t kSum = 8;

void Put(Writer& w, const Alive& a) {
  w.Byte(static_cast<uint8_t>(a.phase));
  for (const uint64_t word : a.heard.words) w.Number(word);
  if (a.phase < Phase::kEnded) return;
  for (const uint64_t count : a.sent) w.Number(count);
  for (const uint64_t count : a.taken) w.Number(count);
}

void Get(Reader& r, size_t robots, Alive& a) {
  a.phase = static_cast<Phase>(r.Number(static_cast<uint64_t>(Phase::kGone)));
  for (size_t w = 0; w < a.heard.words.size(); ++w) {
    const size_t below = robots > 64 * w ? robots - 64 * w : 0;
    a.heard.words[w] = r.Number(below >= 64 ? UINT64_MAX : (uint64_t{1} << below) - 1);
  }
  if (a.phase < Phase::kEnded) return;
  for (auto* counts : {&a.sent, &a.taken}) {
    counts->resize(robots);
    for (uint64_t& count : *counts) count = r.Number(codec::kMostNumber);
  }
}

void Put(Writer& w, const Frame& f) {
  w.Byte(static_cast<uint8_t>(f.kind));
  w.Number(f.to);
  w.Number(f.number);
  if (f.kind == Frame::Kind::kTaken) return;
  w.Block({reinterpret_cast<const uint8_t*>(f.label.data()), f.label.size()});
  w.Number(f.values.size());
  for (const double v : f.values) w.Fixed(std::bit_cast<uint64_t>(v));
}

void Get(Reader& r, size_t robots, Frame& f) {
  f.kind = static_cast<Frame::Kind>(r.Number(static_cast<uint64_t>(Frame::Kind::kTaken)));
  f.to = static_cast<uint32_t>(r.Number(robots - 1));
  f.number = r.Number(codec::kMostNumber);
  if (f.to == f.from) r.Fail();
  if (f.kind == Frame::Kind::kTaken) return;
  const View label = r.Block(kMostLabel);
  f.label.assign(label.begin(), label.end());
  f.values.resize(r.Number(kMostValues));
  for (double& v : f.values) {
    v = std::bit_cast<double>(r.Fixed());
    if (!std::isfinite(v)) r.Fail();
  }
}

}  // namespace

std::string_view Name(Phase phase) {
  switch (phase) {
    case Phase::kGathering:
      return "gathering";
    case Phase::kRunning:
      return "running";
    case Phase::kEnded:
      return "ended";
    case Phase::kFinished:
      return "finished";
    case Phase::kStopped:
      return "stopped";
    case Phase::kGone:
      return "gone";
  }
  return "";
}

void Encode(const Datagram& datagram, uint64_t session, Bytes& out) {
  const size_t begin = out.size();
  out.resize(begin + kSum);
  Writer w(out);
  w.Byte(kMagic);
  w.Byte(kVersion);
  w.Fixed(datagram.agreement);
  w.Fixed(session);
  w.Number(datagram.sender.robot);
  w.Number(datagram.sender.incarnation);
  w.Byte(static_cast<uint8_t>(datagram.body.index()));
  std::visit([&](const auto& body) { Put(w, body); }, datagram.body);
  Bytes sum;
  Writer(sum).Fixed(codec::Sum(View(out).subspan(begin + kSum)));
  std::ranges::copy(sum, out.begin() + static_cast<std::ptrdiff_t>(begin));
}

Refused Decode(View bytes, uint64_t agreement, uint64_t session, size_t robots, Datagram& datagram) {
  if (bytes.size() <= kSum) return Refused::kDamaged;
  if (Reader(bytes.first(kSum)).Fixed() != codec::Sum(bytes.subspan(kSum))) return Refused::kDamaged;
  Reader r(bytes.subspan(kSum));
  if (r.Byte() != kMagic || r.Byte() != kVersion) return Refused::kForeign;
  datagram.agreement = r.Fixed();
  const uint64_t theirs = r.Fixed();
  if (!r.ok()) return Refused::kMalformed;
  if (datagram.agreement != agreement) return Refused::kForeign;
  if (theirs != session) return Refused::kSession;
  datagram.sender.robot = static_cast<uint32_t>(r.Number(robots - 1));
  datagram.sender.incarnation = r.Number(codec::kMostNumber);
  if (r.Number(1) == 0) {
    Get(r, robots, datagram.body.emplace<Alive>());
  } else {
    Frame& frame = datagram.body.emplace<Frame>();
    frame.session = session;
    frame.from = datagram.sender.robot;
    Get(r, robots, frame);
  }
  return r.Complete() ? Refused::kNothing : Refused::kMalformed;
}

}  // namespace rondo::runtime::sessions
